// Sums over all cells, weighted with the squared extinction, of products of an iteration's differences: a part for each work group.
// 0: residual^2, 1: result^2, 2: moved^2, then by slot: the newest difference of residuals with each, and the residual with each.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/smoke_state.glsl"
#include "compensated_ray_marching/scatterer.glsl"
layout(std430, binding = AT_MEANS) readonly buffer Means { float means[]; };
layout(std430, binding = AT_DENSITIES) readonly buffer Densities { float densities[]; };
layout(std430, binding = AT_RESULT) readonly buffer Result { float result[]; };
layout(std430, binding = AT_PARTS) writeonly buffer Parts { double parts[]; };  // [group][3 + 2 KEPT]
uniform int cells;
const int sums = 3 + 2 * KEPT;
shared double together[LOCAL_SIZE_X];

void main() {
  if (done != 0) return;
  int local = int(gl_LocalInvocationIndex), used = min(iteration - 1, KEPT), slot = (iteration - 2) % KEPT;
  int plane = lights * cells, stride = int(gl_NumWorkGroups.x) * LOCAL_SIZE_X;
  for (int s = 0; s < sums; ++s) {
    int other = (s - 3) % KEPT;
    bool wanted = s < 2 || (s == 2 && iteration > 1) || (s > 2 && other < used);
    double sum = 0;
    if (wanted)
      for (int i = int(gl_GlobalInvocationID.x); i < plane; i += stride) {
        int l = i / cells, cell = i % cells;
        double extinct = double(densities[cell]);
        float a = means[plane + i], b = a;  // the residual
        if (s == 1) a = b = result[(first_light + l) * BANDS * cells + cell];
        if (s == 2) a = b = means[2 * plane + i];
        if (s > 2) b = means[(3 + other) * plane + i];
        if (s > 2 && s < 3 + KEPT) a = means[(3 + slot) * plane + i];
        sum += extinct * extinct * double(a) * double(b);
      }
    together[local] = sum;
    barrier();
    for (int half_way = LOCAL_SIZE_X / 2; half_way > 0; half_way /= 2) {
      if (local < half_way) together[local] += together[local + half_way];
      barrier();
    }
    if (local == 0) parts[int(gl_WorkGroupID.x) * sums + s] = together[0];
    barrier();
  }
}
