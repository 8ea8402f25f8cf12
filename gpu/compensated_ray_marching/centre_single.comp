// J_ss at the centres, in harmonics of propagation directions: what passes times the light, scattered (SourceRadiance::at). Both have
// PARTS: bands, or directions, whose products are of one with itself.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/triple_product.glsl"
layout(std430, binding = AT_PASSED) readonly buffer Passed { double passed[]; };          // [extinction][part][centre]
layout(std430, binding = AT_LIGHT_BANDS) readonly buffer LightBands { double light[]; };  // [channel][part], lookup directions
layout(std430, binding = AT_SINGLE_BANDS) writeonly buffer Single { double single[]; };   // [channel][band][centre]
uniform int gaussian_count;
uniform int extinction_of[3];  // of each channel
uniform double albedo[3];
uniform double moment[BANDS];  // (-1)^l times the phase function's

void main() {
  int i = int(gl_GlobalInvocationID.x), b = int(gl_GlobalInvocationID.y), c = int(gl_GlobalInvocationID.z);
  if (i >= gaussian_count) return;
  double sum = 0;
  for (int t = terms[b].i; t < terms[b].j; ++t)
    sum += terms[t].value * light[c * PARTS + terms[t].i] * passed[(extinction_of[c] * PARTS + terms[t].j) * gaussian_count + i];
  single[(c * BANDS + b) * gaussian_count + i] = albedo[c] * moment[b] * sum;
}
