// A density over the sphere proportional to values on a lat-long grid, interpolated: what importance-samples a map.
//
// Between texel centres the density is linear in longitude and in the cosine of the polar angle, so it has a closed
// form (no table is needed to evaluate it), can be sampled exactly, and vanishes only where the bilinear map itself
// does. Against a map that is linear in the angle itself the ratio stays between 1 and 2 in the strips that touch the
// polar caps, and within O(height^-2) of 1 elsewhere.
#pragma once
#include <vector>

#include "scene/lat_long.h"
#include "scene/math/types.h"

namespace airlight::scene {

class LatLongDensity {
 public:
  // width * height values >= 0, finite, row 0 at +y, x fastest.
  LatLongDensity(int width, int height, const std::vector<double>& values);

  // False if all values are 0: then there is nothing to sample.
  bool positive() const { return total_ > 0; }
  // Density over solid angle [1/sr]; integrates to 1. Requires positive().
  double pdf(const Vec3& direction) const {
    return pdf(find_cell(to_lat_long(direction), width_, height_), direction[1]);
  }
  // The same, where the direction's cell and the cosine of its polar angle are known.
  double pdf(const LatLongCell&, double y) const;
  // The direction for two uniforms in [0, 1); monotone in u1 from pole to pole, then in u2 around. Requires positive().
  Vec3 sample(double u1, double u2) const;

 private:
  int width_, height_;
  std::vector<float> values_;   // over their maximum
  std::vector<double> cosine_;  // height + 2: where strips begin
  std::vector<double> strips_;  // height + 2: cumulated share of the strips
  std::vector<double> cells_;   // (height + 1) x (width + 1): cumulated share of the cells of each strip
  double total_ = 0;            // integral of the interpolant over the sphere
};

}  // namespace airlight::scene
