// Bounds for blocks of cells (methods/wavelet_fog/blocks.h). STAGE 0: for each cell, the greatest |coefficient| that reaches it, or
// |coefficient - prolonged|; 1: the greatest of the four blocks in one; 2: how large a block around each cell is empty.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define VALUES_ACCESS
#include "wavelet_fog/grids.glsl"
uniform int from, to;

#if STAGE == 0
uniform int less;  // a grid to subtract; -1: none
void main() {
  Grid source = grids[from], target = grids[to];
  ivec2 index = ivec2(gl_GlobalInvocationID.xy), cell = index + lo_of(target);
  if (index.x >= target.size_u || index.y >= target.size_v) return;
  float most = 0;
  for (int k = 0; k <= DEGREE; ++k)
    for (int m = 0; m <= DEGREE; ++m) {
      ivec2 at = cell - ivec2(m, k);
      float value = value_in(source, at);
      if (less >= 0) {
        float other = value_in(grids[less], at);
        // Upwards by what both are rounded by: bounds must hold.
        value = abs(value - other) + 2e-6 * max(abs(value), abs(other));
      }
      most = max(most, abs(value));
    }
  values[place_of(target, cell)] = most;
}
#elif STAGE == 1
void main() {
  Grid target = grids[to];
  ivec2 index = ivec2(gl_GlobalInvocationID.xy), block = index + lo_of(target);
  if (index.x >= target.size_u || index.y >= target.size_v) return;
  float most = 0;
  for (int c = 0; c < 4; ++c) most = max(most, value_in(grids[from], 2 * block + ivec2(c & 1, c >> 1)));
  values[place_of(target, block)] = most;
}
#else
#define EMPTINESS_ACCESS writeonly
#include "wavelet_fog/emptiness.glsl"
uniform int levels;  // grids from, from + 1, ..., from + levels hold what is greatest in blocks of 1, 2, 4, ... cells
void main() {
  int row = int(gl_GlobalInvocationID.y), word = int(gl_GlobalInvocationID.x);
  Grid cells = grids[from];
  if (row >= cells.size_v || 8 * word >= cells.size_u) return;
  uint bits = 0u;
  for (int i = 0; i < 8; ++i) {
    ivec2 cell = lo_of(cells) + ivec2(8 * word + i, row);
    uint empty = 0u;
    while (int(empty) <= levels && holds(cells, cell) && value_in(grids[from + int(empty)], cell >> int(empty)) == 0) ++empty;
    bits |= empty << (4 * i);
  }
  emptiness[row * words_in_row(cells) + word] = bits;
}
#endif
