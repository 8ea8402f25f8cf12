// The inner loop of LightMap: interpolation at many points of a ray at once.
#pragma once

namespace airlight::fogshop {

struct MapLookup {
  const float* depths;  // [row][column][edge], directions + 2 rows and columns, edges + 1 edges
  int directions, edges;
  double near, far;  // distances of the first and the last edge [m]; in between even if near > 0, else quadratic
  double tangent;    // half the width of a perspective view along +z at distance 1; 0: octahedral
};

// Depths at the points start + t step, as seen from the light in the map's axes. `t` and `depth` hold a multiple of 8
// values. Zero before the first edge and outside the view, constant behind the last edge.
void look_up(const MapLookup&, const double start[3], const double step[3], const double* t, int count, double* depth);

}  // namespace airlight::fogshop
