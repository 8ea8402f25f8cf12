// A map at several resolutions, and the optical depth of a ray by levels of detail. Giroud and Biri 2010, sections 4.2
// and 4.3. Algorithm 1 can be read in two ways; Table 2 allows one: m = 0 is the coarsest approximation, complete; details m = 1 to L, of
// which L is the finest, count up to the distance |OP| mu^m from the eye. Grids are numbered the other way: l = L - m, from the map, l = 0.
#pragma once
#include <string>

#include "methods/wavelet_fog/decomposition.h"
#include "scene/media/spline_map.h"

namespace airlight::wavelet_fog {

// How coarse grids are made.
enum class Coarse {
  wavelet,     // the family's analysis: of any sign, as the paper's
  clamped,     // wavelet, with negative values set to 0 and the sum restored: a copy that can be rendered alone
  restricted,  // p / 2: never negative
};

struct Levels {
  std::vector<scene::SplineMap> grid;    // 0: the map; l: with cells 2^l times as large
  std::vector<scene::SplineMap> detail;  // l in 0 to levels - 1: what grid l has beyond grid l + 1
  int count() const { return int(grid.size()) - 1; }
};

// Throws Error where `levels` is above most_levels. Details only where asked for.
Levels make_levels(const scene::SplineMap&, const std::string& family, Coarse, int levels, bool details);

// The part of the ray that counts: up to `length`, or where it leaves the ground's box of the coarsest grid for good
// (for the sky |OP| is infinite). Height is not clipped. 0 if it misses the box.
double length_in_box(const Levels&, const scene::MapLine&, double length);

// Eq. 4, whose exp Eq. 11 and Algorithm 1's last line leave out: radiance from behind through the depth, and the fog's own. Opacity by expm1: 1 - exp loses all digits of thin fog.
double composite(double depth, double behind, double fog);

// Throws Error unless mu is in [0, 1].
void require_share(double mu);

// d_max of detail m: length mu^m; mu^0 = 1 also for mu = 0.
double reach_of(int m, double length, double mu);

// Counts of a ray's reads.
struct Visits {
  long cells = 0, coefficients = 0, lookups = 0;
};
// Integral of f h over t of one grid [m].
double integral_of_level(const scene::SplineMap&, int level, const scene::HeightProfile&, const scene::MapLine&,
                         Interval t, Visits&);
// Integral of f h over [0, length] within `inside`; length as length_in_box gives it. All levels summed, of any sign: the
// paper after deconstruction.
double summed_depth(const Levels&, const scene::HeightProfile&, const scene::MapLine&, Interval inside, double length,
                    double mu, Visits&);
// Like summed_depth, but reads one grid at a time: between two reaches the sum of details equals the finer grid.
double telescoped_depth(const Levels&, const scene::HeightProfile&, const scene::MapLine&, Interval inside,
                        double length, double mu, Visits&);

}  // namespace airlight::wavelet_fog
