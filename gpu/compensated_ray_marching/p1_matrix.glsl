// The matrix of p1_matrix.comp: rows of cells, with entries for the six neighbours.
layout(std430, binding = AT_MATRIX) buffer Matrix { double matrix[]; };  // [share of the next face along x, y, z; diagonal; inverse][cell]
#define DIAGONAL 3
#define INVERSE 4

// What the row of a cell takes of the cell beside it; 0 where there is none.
double share_of(int cell, int axis, int side) {
  int low = side < 0 ? cell - stride_of(axis) : cell;
  return low < 0 ? 0.0LF : matrix[axis * cell_count() + low];
}
