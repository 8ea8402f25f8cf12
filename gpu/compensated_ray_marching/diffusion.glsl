// The diffusion system at the centres: methods/compensated_ray_marching/diffusion_system.h, Zhou et al. 2008, Eq. 13, in double precision,
// for its condition is a thousand and more, and gradients square it. A row is a work group's, its columns are shared out among the lanes.
#include "compensated_ray_marching/doubles.glsl"
layout(std430, binding = AT_CENTRES) readonly buffer Centres { double gaussians[]; };  // center, width [m], amplitude
uniform int gaussian_count;
#define lane int(gl_LocalInvocationIndex)
const int lanes = LOCAL_SIZE_X;
shared double parts[SUMS * lanes], totals[SUMS];

struct Derivatives {
  double value, laplacian;
  dvec3 gradient;
};
dvec3 centre(int i) { return dvec3(gaussians[5 * i], gaussians[5 * i + 1], gaussians[5 * i + 2]); }
Derivatives derivatives_at(int i, dvec3 x) {
  dvec3 offset = x - centre(i);
  double square = gaussians[5 * i + 3] * gaussians[5 * i + 3], far = dot(offset, offset) / square;
  double value = gaussians[5 * i + 4] * exp_double(-far);
  return Derivatives(value, value * (4 * far - 6) / square, -2 / square * value * offset);
}

// totals[s] = sum of parts[s * lanes + lane] over all lanes.
void add_up() {
  barrier();
  if (lane < SUMS) {
    double sum = 0;
    for (int k = 0; k < lanes; ++k) sum += parts[lane * lanes + k];
    totals[lane] = sum;
  }
  barrier();
}
