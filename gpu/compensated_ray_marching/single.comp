// J_ss at the nodes with smoke in real spherical harmonics: light left of each direction, scattered (LitGrid::scatter_again).
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/scatterer.glsl"
layout(std430, binding = AT_COLUMNS) readonly buffer Columns { float columns[]; };  // [direction][node, m]; 1e37: blocked
layout(std430, binding = AT_POWERS) readonly buffer Powers { vec4 powers[]; };
layout(std430, binding = AT_HARMONICS) readonly buffer Harmonics { vec4 harmonics[]; };   // [direction][band / 4]
layout(std430, binding = AT_NODES) readonly buffer Nodes { int nodes[]; };                // their cells
layout(std430, binding = AT_SINGLE) writeonly buffer Single { float single_source[]; };   // [light][band][cell]
uniform int node_count, directions, cells;

void main() {
  int i = int(gl_GlobalInvocationID.x), l = int(gl_GlobalInvocationID.y);
  if (i >= node_count || l >= lights) return;
  int c = channel[l];
  vec4 sum[ROWS];  // four bands a row: 2048 directions with 36 bands each would exceed llvmpipe's limit on loops
  for (int r = 0; r < ROWS; ++r) sum[r] = vec4(0);
  for (int k = 0; k < directions; ++k) {
    float left = powers[k][c] * exp(-min(sigma_t[c] * columns[k * node_count + i], 200.0));
    for (int r = 0; r < ROWS; ++r) sum[r] += harmonics[k * ROWS + r] * left;
  }
  for (int b = 0; b < BANDS; ++b)
    single_source[((first_light + l) * BANDS + b) * cells + nodes[i]] = albedo[c] * moment[b] * sum[b / 4][b % 4];
}
