// Transmittance to the centres of the Gaussians, for every distinct extinction: computed once per smoke.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/passed.glsl"
layout(std430, binding = AT_PASSED) writeonly buffer Passed { double passed[]; };  // [extinction][band][centre]
uniform int extinctions;
uniform double extinction[3];  // [1/m]

void main() {
  int i = int(gl_WorkGroupID.x);
  dvec3 x = dvec3(gaussians[5 * i], gaussians[5 * i + 1], gaussians[5 * i + 2]);
  find_hidden(x, -1);
  find_depth(x);
  for (int e = 0; e < extinctions; ++e) {
    pass(extinction[e]);
    if (lane < BANDS) passed[(e * BANDS + lane) * gaussian_count + i] = vectors[RESULT + lane];
    barrier();
  }
}
