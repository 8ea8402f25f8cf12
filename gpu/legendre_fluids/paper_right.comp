// Begins systems: their right sides, of the light that comes in (eq. 22), or of what is scattered of all lights (eq. 23); solutions are 0.
#include "legendre_fluids/paper.glsl"
layout(std430, binding = AT_DIRECT) readonly buffer Direct { double direct[]; };  // E_d: [light][extinction][coefficient]
uniform int scatters;
uniform double amounts[SYSTEMS * LIGHTS];  // of each light: scattering along the ray per density [1/m]
uniform int extinctions[SYSTEMS], scatterers[SYSTEMS];

// Right side for inflowing light of 1: on a face a constant has one coefficient, twice its value.
double inflow_side(int e) {
  ivec3 index = index_of(e);
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    if (index[(a + 1) % 3] == 0 && index[(a + 2) % 3] == 0) sum += inflow_weight(a) * 2 * end_of(a, index[a]);
  return sum;
}

void main() {
  int right = base + VECTORS_AT, x = base + SOLUTION_AT;
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) {
    double sum = 0;
    for (int l = 0; l < LIGHTS && scatters != 0; ++l)
      sum += amounts[system * LIGHTS + l] * direct[(l * EXTINCTIONS + extinctions[system]) * UNKNOWNS + e];
    if (scatters != 0)
      work[x + e] = sum;
    else
      work[right + e] = inflow_side(e);
  }
  together();
  if (scatters != 0) {
    of_density = scatterers[system];
    int from = product(false, x), to = UPWIND != 0 ? right : x;
    of_density = 0;
    for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) work[to + e] = work[from + e];
    together();
    if (UPWIND == 0) {
      apply(true, x, right);
      for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) work[right + e] *= per_rate() * per_rate();
      together();
    }
  }
  double size = sqrt(dot_of(right, right));
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) {
    work[x + e] = 0;
    // GMRES begins with a unit vector, conjugate gradients with the residual and a direction.
    if (UPWIND == 0)
      work[right + UNKNOWNS + e] = work[right + e];
    else if (size > 0)
      work[right + e] /= size;
  }
  if (lane > 0) return;
  SIZE_OF_RIGHT = size;
  STEPS_DONE = 0;
  RESIDUAL = !is_number(size) ? lost : size > 0 ? 1 : 0;
  DONE = is_number(size) && size > 0 ? 0 : 1;
  if (UPWIND != 0) work[base + REST_AT] = size;
}
