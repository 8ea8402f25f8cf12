// The density at the points of the products, from its coefficients R.x R.y R.z; and these by polynomials P without a norm, for columns of
// the image. A single work group.
#include "legendre_fluids/paper.glsl"
layout(std430, binding = AT_STATE) readonly buffer State { float state[]; };
layout(std430, binding = AT_KEPT) buffer Kept { float kept[]; };  // faces of paper_image.comp
uniform int first;                                                 // of the coefficients

void main() {
  int one = ROOM_AT, two = one + REGION;
  for (int e = lane; e < R.x * R.y * R.z; e += LOCAL_SIZE_X) {
    vec3 index = vec3(e / (R.y * R.z), e / R.z % R.y, e % R.z) + 0.5;
    work[two + e] = double(state[first + e]);
    kept[DENSITY_AT + e] = sqrt(index.x * index.y * index.z) * state[first + e];
  }
  together();
  to_points(R, OF_DENSITY_AT, R, ivec3(1), two, one, two);
  for (int e = lane; e < ALL_POINTS; e += LOCAL_SIZE_X) density[e] = work[one + e];
}
