// Fog as a map over the ground: density(x) = f(u, v) h(y), f a sum of B-splines with coefficients from an image, h the
// height's factor. Giroud and Biri 2010, section 3.
//
// Map axes are the world's x and z, turned about the y axis:
//   u = ((x - x0) cos a - (z - z0) sin a) / cell,   v = ((x - x0) sin a + (z - z0) cos a) / cell
// Coefficient (i, j), i along u, has its basis over [i, i + n + 1) x [j, j + n + 1). An image of W x H pixels over the
// rectangle from (x_min, z_min) with pixels of `cell` has x0 = x_min - cell n / 2: basis i is centred on pixel i.
#pragma once
#include "scene/media/spline_map.h"

namespace airlight::scene {

struct Fogmap {
  SplineMap map;  // coefficients >= 0
  HeightProfile profile;
  double x0 = 0, z0 = 0;  // [m]
  double cell = 1;        // [m], > 0
  double cos_turn = 1, sin_turn = 0;
  std::string note;  // what was passed over when it was read, one line; empty if nothing
};

// The ray over the map, t in metres. Computed in double: far from its cells a map in single precision is wrong by per
// cents.
MapLine line_over(const Fogmap&, const Ray&);

double density(const Fogmap&, const Point3& x);                  // [-]
Interval density_bounds(const Fogmap&, const Box&);              // rigorous
double density_integral(const Fogmap&, const Ray&, Interval t);  // [m], exact to rounding; may be infinite
Interval extent(const Fogmap&, const Ray&, Interval t);
// The density is 0, or below 1e-17 of the greatest, outside; sides of height may be infinite.
Box support(const Fogmap&);
// Corners of the map's support on the ground: x and z.
std::vector<std::pair<double, double>> ground_corners(const Fogmap&);
// Within t, ascending, without the ends: between them the density on the ray is smooth [m].
std::vector<double> smooth_between(const Fogmap&, const Ray&, Interval t);

}  // namespace airlight::scene
