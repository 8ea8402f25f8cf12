// The right side of the diffusion system, of every light of a solve.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/diffusion.glsl"
#include "compensated_ray_marching/diffusion_vectors.glsl"
layout(std430, binding = AT_SINGLE_BANDS) readonly buffer Single { double single[]; };  // [channel][band][centre]
layout(std430, binding = AT_ROW_SCALES) readonly buffer RowScales { double row_scales[]; };
uniform int channel[3];              // of each system of the solve
uniform double of_mean, of_gradient; // what D J0 and div J1 are multiplied by [1/m, -]
#include "compensated_ray_marching/linear_source.glsl"

void main() {
  int h = int(gl_WorkGroupID.x), z = int(gl_WorkGroupID.z);
  dvec3 x = centre(h);
  for (int s = 0; s < SUMS; ++s) parts[s * lanes + lane] = 0;
  for (int l = lane; l < gaussian_count; l += lanes) {
    Derivatives q = derivatives_at(l, x);
    dvec3 direction = direction_of(channel[z], l);
    parts[lane] += q.value;
    parts[lanes + lane] += q.value * mean_of(channel[z], l);
    parts[2 * lanes + lane] += dot(q.gradient, direction);
    for (int a = 0; a < 3; ++a) {
      parts[(3 + a) * lanes + lane] += q.gradient[a];
      parts[(6 + a) * lanes + lane] += q.value * direction[a];
    }
  }
  add_up();
  if (lane != 0) return;
  dvec3 gradient = dvec3(totals[3], totals[4], totals[5]), direction = dvec3(totals[6], totals[7], totals[8]);
  double divergence = (totals[2] - dot(direction, gradient) / totals[0]) / totals[0];
  vectors[vector_at(z, RIGHT) + h] = row_scales[h] * (of_mean * totals[1] + of_gradient * divergence);
}
