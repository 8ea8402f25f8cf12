// Look-ups in a light's map by vector kernels: plain data and entry points. Every lane is computed alone, in one order of
// operations: results do not depend on the instruction set, nor on how points are grouped.
//
// Arrays hold `n` entries; they must be readable and writable up to n rounded up to a multiple of 64.
#pragma once
#include <cstddef>
#include <cstdint>

#include "reference/light_map/options.h"

namespace airlight::light_map {

// A projection as the kernel knows it: x, y, z local = m * world + b. Orthographic: texels of the map, and the share of
// its depths. Octahedral: metres around the light, along the octahedron's axes.
struct PlaceRule {
  bool octahedral, whole_sphere;
  double m[9], b[3];
  int size;
  double per_reach;        // octahedral: half of the texels a side, over the reach
  double near, per_range;  // octahedral: where depths begin [m], 1 over their range
};
struct Projection;
PlaceRule rule_of(const Projection&);

// The texel left and below of a point, counted in floats of a plane; shares of its neighbours; depth in [0, 1], 0
// where nothing lies between the point and the light.
struct Places {
  std::int32_t* texel;
  float *x, *y, *depth;
};
void find_places(const PlaceRule&, int floats_per_texel, std::size_t n, const double* x, const double* y,
                 const double* z, const Places&);

// One optical depth of a map, row by row with its border.
struct MapView {
  const float* texels;
  int row;  // floats of a row
  Options options;
  bool negative;  // may optical depths be negative? Where not, a series that falls below 0 is cut there
};
void look_up(const MapView&, std::size_t n, const Places&, float* optical_depth);

}  // namespace airlight::light_map
