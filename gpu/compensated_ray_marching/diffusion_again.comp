// Multiple scattering from the mean radiance at the centres: scattered_radiance of diffusion_system.h, as bands 0 and 1 of sources.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/diffusion.glsl"
#include "compensated_ray_marching/diffusion_vectors.glsl"
layout(std430, binding = AT_SINGLE_BANDS) readonly buffer Single { double single[]; };  // [channel][band][centre]
layout(std430, binding = AT_AGAIN) writeonly buffer Again { double again[]; };          // [channel][4][centre]
uniform int channel[3];  // of each system of the solve; where all channels have one system, the first
uniform int channels;    // that each system stands for: 1, or all of the solve's
uniform double albedo, mean_cosine, sigma_t, factor;  // of the solve; factor: 1 or 3 over 3 sigma_tr [m]
#include "compensated_ray_marching/linear_source.glsl"

void main() {
  int h = int(gl_WorkGroupID.x), z = int(gl_WorkGroupID.z), solution = vector_at(z, SOLUTION);
  dvec3 x = centre(h);
  for (int s = 0; s < SUMS; ++s) parts[s * lanes + lane] = 0;
  for (int l = lane; l < gaussian_count; l += lanes) {
    Derivatives q = derivatives_at(l, x);
    dvec3 direction = direction_of(channel[z], l);
    double mean = max(vectors[solution + l], 0.0LF);
    parts[lane] += q.value;
    parts[lanes + lane] += q.value * mean;
    for (int a = 0; a < 3; ++a) {
      parts[(2 + a) * lanes + lane] += q.gradient[a];
      parts[(5 + a) * lanes + lane] += mean * q.gradient[a];
      parts[(8 + a) * lanes + lane] += q.value * direction[a];
    }
  }
  add_up();
  if (lane != 0) return;
  double D = totals[0], here = totals[1] / D;
  dvec3 gradient = dvec3(totals[2], totals[3], totals[4]), weighted = dvec3(totals[5], totals[6], totals[7]);
  dvec3 along = factor / D * (-(weighted - here * gradient) / D + sigma_t * dvec3(totals[8], totals[9], totals[10]));
  // J1 = sqrt(3 / 4 pi) (-f3, -f1, f2): linear_source's.
  double mean = 3.5449077018110318LF * albedo * max(vectors[solution + h], 0.0LF);
  along *= 2.0466534158929770LF * albedo * mean_cosine;
  for (int k = 0; k < channels; ++k) {
    int at = 4 * channel[z + k] * gaussian_count + h;
    again[at] = mean;
    again[at + gaussian_count] = -along.y;
    again[at + 2 * gaussian_count] = along.z;
    again[at + 3 * gaussian_count] = -along.x;
  }
}
