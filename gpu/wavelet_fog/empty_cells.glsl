// Empty cells of the current medium. Needs fog.glsl.
#define EMPTINESS_ACCESS readonly
#include "wavelet_fog/emptiness.glsl"

// -1: there is something in the cell; else the level of the largest empty block around it. all: grids[fog.cells].
int empty_around(Grid all, ivec2 cell) {
  ivec2 index = cell - lo_of(all);
  return int(emptiness[fog.first_word + index.y * words_in_row(all) + index.x / 8] >> (4 * (index.x & 7)) & 15u) - 1;
}
