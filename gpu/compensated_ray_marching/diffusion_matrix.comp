// The matrix of the diffusion system, once for a smoke: diffusion_system. `scaled`: rows of length 1, and what they were divided by.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/diffusion.glsl"
layout(std430, binding = AT_MATRIX) buffer Matrix { double matrix[]; };              // [row][column]
layout(std430, binding = AT_ROW_SCALES) writeonly buffer RowScales { double row_scales[]; };
uniform double transport, absorption;  // sigma_tr, (1 - albedo) sigma_t [1/m]
uniform int scaled;

void main() {
  int h = int(gl_WorkGroupID.x);
  dvec3 x = centre(h);
  for (int s = 0; s < SUMS; ++s) parts[s * lanes + lane] = 0;
  for (int l = lane; l < gaussian_count; l += lanes) {
    Derivatives q = derivatives_at(l, x);
    parts[lane] += q.value;
    parts[lanes + lane] += q.laplacian;
    for (int a = 0; a < 3; ++a) parts[(2 + a) * lanes + lane] += q.gradient[a];
  }
  add_up();
  double D = totals[0], laplacian = totals[1], kappa = 1 / (3 * transport * D), square = 0;
  dvec3 gradient = dvec3(totals[2], totals[3], totals[4]);
  for (int l = lane; l < gaussian_count; l += lanes) {
    Derivatives q = derivatives_at(l, x);
    double share = q.value / D;
    dvec3 of_share = (q.gradient - share * gradient) / D;
    double bend = (q.laplacian - share * laplacian - 2 * dot(of_share, gradient)) / D;
    double entry = kappa * (bend - dot(of_share, gradient) / D) - absorption * D * share;
    matrix[h * gaussian_count + l] = entry;
    square += entry * entry;
  }
  double scale = 1;
  if (scaled != 0) {
    parts[lane] = square;
    add_up();
    if (totals[0] > 0) scale = 1 / sqrt(totals[0]);
    for (int l = lane; l < gaussian_count; l += lanes) matrix[h * gaussian_count + l] *= scale;
  }
  if (lane == 0) row_scales[h] = scale;
}
