// A density over the sphere proportional to values on a lat-long grid, interpolated: what importance-samples a map.
//
// Between texel centres the density is linear in longitude and in the cosine of the polar angle, so it has a closed
// form (no table is needed to evaluate it), can be sampled exactly, and vanishes only where the bilinear map itself
// does. Against a map that is linear in the angle itself the ratio stays between 1 and 2 in the strips that touch the
// polar caps, and within O(height^-2) of 1 elsewhere.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/light/lat_long.h"
#include "scene/math/types.h"

namespace airlight::scene {

class LatLongDensity {
 public:
  // width * height values >= 0, finite, row 0 at +y, x fastest; `rgb` holds three per texel, or none.
  LatLongDensity(int width, int height, const std::vector<double>& values, const std::vector<float>& rgb = {});

  // False if all values are 0: then there is nothing to sample.
  bool positive() const { return total_ > 0; }
  // Density over solid angle [1/sr]; integrates to 1. Requires positive().
  double pdf(const Vec3& direction) const {
    return pdf(find_cell(to_lat_long(direction), width_, height_), direction[1]);
  }
  // Density for a direction whose cell and cosine of the polar angle are known.
  double pdf(const LatLongCell&, double y) const;
  // The colours that came with the values, bilinear. They lie beside the values in memory: a large map is nowhere near
  // the processor, and whoever samples it asks for both.
  Rgb colour(const LatLongCell&) const;
  // The direction for two uniforms in [0, 1); monotone in u1 from pole to pole, then in u2 around. Requires positive().
  Vec3 sample(double u1, double u2) const;

 private:
  struct alignas(16) Texel {
    float rgb[3];
    float value;  // over the greatest
  };
  // Entry k of a guide is the bin that holds u = k / (entries - 1): inverting a cumulated sum looks at one stretch of
  // it.
  using Guide = std::vector<std::uint32_t>;
  static constexpr int bins_per_entry = 4;
  static int guide_entries(int bins) { return bins / bins_per_entry + 2; }
  static void make_guide(const double* shares, int bins, std::uint32_t* guide);
  static int choose(const double* shares, int bins, const std::uint32_t* guide, double& u);
  const Texel* row(int j) const { return &texels_[std::size_t(j) * width_]; }

  int width_, height_;
  std::vector<Texel> texels_;
  std::vector<double> cosine_;  // height + 2: where strips begin
  std::vector<double> strips_;  // height + 2: cumulated share of the strips
  std::vector<double> cells_;   // (height + 1) x (width + 1): cumulated share of the cells of each strip
  Guide strip_guide_, cell_guide_;
  double total_ = 0;  // integral of the interpolant over the sphere
};

}  // namespace airlight::scene
