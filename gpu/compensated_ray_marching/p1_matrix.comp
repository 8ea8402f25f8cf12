// The matrix of diffusion on a grid: shares of faces between cells, the diagonal, and the inverse of it that gradients use.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/p1.glsl"
#include "compensated_ray_marching/p1_matrix.glsl"
uniform int stage;

void main() {
  int at = int(gl_GlobalInvocationID.x), count = cell_count();
  if (at >= count) return;
  Cell cell = cell_of(at);
  if (stage == STAGE_FACES) {
    double sum = (1 - albedo) * extinction_of(at);
    for (int axis = 0; axis < 3; ++axis) {
      double above = 0;
      if (ends_on(axis)) {
        above = 1 / (resistance(cell, axis, 1) * edge_on(axis));
        sum += above + 1 / (resistance(cell, axis, -1) * edge_on(axis));
      }
      matrix[axis * count + at] = beside(cell, axis, 1) < 0 ? 0.0LF : above;
    }
    matrix[DIAGONAL * count + at] = sum;
  } else {  // cells of colour 0 are eliminated: what is left of the others' diagonal
    double left = matrix[DIAGONAL * count + at];
    for (int axis = 0; axis < 3 && (cell.place.x + cell.place.y + cell.place.z) % 2 != 0; ++axis)
      for (int side = -1; side < 2; side += 2) {
        double share = share_of(at, axis, side);
        if (share != 0) left -= share * share / matrix[DIAGONAL * count + at + side * stride_of(axis)];
      }
    matrix[INVERSE * count + at] = 1 / left;
  }
}
