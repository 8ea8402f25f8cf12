// Diffusion on a grid of cells, in double precision: methods/compensated_ray_marching/p1_grid.h. A vacuum beside thick smoke makes the
// condition of the system so bad that single precision would not reach the tolerance.
layout(std430, binding = AT_DENSITIES) readonly buffer Densities { float densities[]; };  // of the cells, x fastest
uniform vec3 cells_along, with_ends;                // each axis; 0: nothing changes along it, and nothing ends
uniform dvec3 cell_edges;                           // [m]
uniform double sigma_t, albedo, transport, vacuum;  // transport: 3 (1 - albedo g); vacuum: extinction that a vacuum has instead [1/m]
#define lane int(gl_LocalInvocationIndex)

int cell_count() { return int(cells_along.x) * int(cells_along.y) * int(cells_along.z); }
int on_axis(ivec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
int stride_of(int axis) { return axis == 0 ? 1 : axis == 1 ? int(cells_along.x) : int(cells_along.x) * int(cells_along.y); }
double edge_on(int axis) { return axis == 0 ? cell_edges.x : axis == 1 ? cell_edges.y : cell_edges.z; }
bool ends_on(int axis) { return (axis == 0 ? with_ends.x : axis == 1 ? with_ends.y : with_ends.z) != 0; }

struct Cell {
  int at;
  ivec3 place;
};
Cell cell_of(int at) {
  ivec3 size = ivec3(cells_along);
  int row = at / size.x;
  return Cell(at, ivec3(at % size.x, row % size.y, row / size.y));
}
// The cell beside another, on a side (-1 or 1) along an axis; -1 outside.
int beside(Cell cell, int axis, int side) {
  int place = on_axis(cell.place, axis) + side;
  return place < 0 || place >= on_axis(ivec3(cells_along), axis) ? -1 : cell.at + side * stride_of(axis);
}

double extinction_of(int cell) { return sigma_t * double(densities[cell]); }
double half_resistance(int cell, int axis) {
  return 0.5LF * edge_on(axis) * transport * max(extinction_of(cell), vacuum);
}
// Resistance of the face on that side: flux = (L0 of low - L0 of high + push) / resistance. Marshak adds 2 where nothing is beyond.
double resistance(Cell cell, int axis, int side) {
  int other = beside(cell, axis, side);
  return half_resistance(cell.at, axis) + (other < 0 ? 2.0LF : half_resistance(other, axis));
}

// The cells by colour: 0 those of an even sum of places. All neighbours of a cell have the other colour. -1 beyond the last.
int cells_of_colour() { return (int(cells_along.x) + 1) / 2 * int(cells_along.y) * int(cells_along.z); }
int cell_of_colour(int i, int colour) {
  int half_row = (int(cells_along.x) + 1) / 2, row = i / half_row;
  int x = 2 * (i % half_row) + (row % int(cells_along.y) + row / int(cells_along.y) + colour) % 2;
  return x < int(cells_along.x) ? x + int(cells_along.x) * row : -1;
}
