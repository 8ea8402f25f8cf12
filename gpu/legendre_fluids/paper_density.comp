// The density at the points of the products, from its coefficients R.x R.y R.z; a single work group.
#include "legendre_fluids/paper.glsl"
layout(std430, binding = AT_STATE) readonly buffer State { float state[]; };
uniform int first;  // of the coefficients

void main() {
  int one = ROOM_AT, two = one + REGION;
  for (int e = lane; e < R.x * R.y * R.z; e += LOCAL_SIZE_X) work[two + e] = double(state[first + e]);
  together();
  to_points(R, OF_DENSITY_AT, R, ivec3(1), two, one, two);
  for (int e = lane; e < ALL_POINTS; e += LOCAL_SIZE_X) density[e] = work[one + e];
}
