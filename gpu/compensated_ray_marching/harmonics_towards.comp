// Harmonics of one direction, in single precision: what oracle vectors are compared with.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/spherical_harmonics.glsl"
layout(std430, binding = AT_RESULT) writeonly buffer Result { float result[]; };
uniform vec3 direction;

void main() {
  for (ShPair y = first_pair(direction); y.m < sh_order; next_pair(y, direction)) {
    result[y.l * (y.l + 1) - y.m] = y.minus;
    result[y.l * (y.l + 1) + y.m] = y.plus;
  }
}
