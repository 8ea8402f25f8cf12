// A fogmap from another medium's columns: what is over each place of the ground, without where in height. Giroud and Biri 2010, section 4.1:
// "the result of a simulation, which was exported as a fogmap".
#pragma once
#include <vector>

#include "scene/media/fogmap.h"
#include "scene/media/medium.h"

namespace airlight::scene {

// Pixels over the ground: `width` x `height` of `cell` metres, x fastest; the corner of pixel (0, 0) at (x0, z0) [m].
struct GroundPixels {
  int width = 1, height = 1;
  double cell = 1;
  double x0 = 0, z0 = 0;
};

// Square pixels that cover the field's box, `longer` of them along its longer side. Throws Error for an infinite field.
GroundPixels ground_pixels(const DensityField&, int longer);

// The columns over each pixel [m]: means over samples^2 upright rays. Throws Error for a field without an end in height.
std::vector<double> column_densities(const DensityField&, const GroundPixels&, int samples);

struct ColumnFogmap {
  Fogmap map;                // equal at all heights: its medium's region ends it
  Interval heights;          // of the field's box [m]; columns are spread over them
  double column_error = 0;   // of the columns, relative L2, over upright rays between those that made the map
  double density_error = 0;  // of the density, relative L2, over a lattice in the box: the cost of losing the height
  double column_ratio = 0;   // sum of the map's columns over that of the field's
};
// Pixels as coefficients of splines of that degree (0 to 3), centred on them.
ColumnFogmap fogmap_from_columns(const DensityField&, const GroundPixels&, int samples, int degree);

}  // namespace airlight::scene
