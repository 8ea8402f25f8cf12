// Columns of a fogmap towards a sun: one map over the ground, made once per sun and fog, from which the column at every
// height follows. (Giroud and Biri 2010, section 5, name shadows inside the fog as future work.)
//
// Rows of the map run along the sun's azimuth a. With p the place along a [cells], to the sun's side of a point:
//   F_0 = integral of f dp',  F_1 = integral of (p' - p) f dp',  E = integral of f exp(-k (p' - p)) dp',
// k the scale heights that the way to the sun climbs per cell. A ray to the sun climbs evenly, so that a factor of the
// height that is none or made of straight lines is alpha + beta p' between knots, and takes differences of F_0 and F_1; above
// its base an exponential one is h(y) E(p): exact at all heights, but for interpolation between the map's entries.
#pragma once
#include <memory>
#include <vector>

#include "scene/media/medium.h"
#include "scene/renderer.h"

namespace airlight::wavelet_fog {

// Where the entries of a map are.
struct SunRows {
  bool upright = false;      // no azimuth: there is no map, columns are walked
  double along[2] = {1, 0};  // the azimuth in u and v
  double across = 0;         // cells over the ground per metre to the sun
  double k = 0;              // scale heights per cell
  double lo[2] = {0, 0};     // first p and q of the rows [cells]
  int columns = 0, rows = 0;

  bool operator==(const SunRows&) const = default;
};
SunRows rows_towards(const scene::Fogmap&, const Vec3& to_sun, double step);

class SunMap {
 public:
  static constexpr double least_way =
      2;  // cells over the ground up to which the walk is as short as a lookup, and exact
  static constexpr double most_entries = 1 << 25;
  // Number of entries of a map with this step.
  static double entries(const scene::Fogmap&, const Vec3& to_sun, double step);

  // The medium is a fogmap and must outlive this object. to_sun: unit vector, not below the horizon where the profile
  // is exponential. There is an entry every `step` cells along rows, and a row every `step` cells. `before`: the map of
  // the previous frame, with its medium still alive, or null. Its entries are shared if the fog has only moved over the
  // ground, or has not changed.
  SunMap(const scene::Medium&, const Vec3& to_sun, double step, const scene::Execution&,
         const SunMap* before = nullptr);

  // Are they those of `other`?
  bool shares_entries(const SunMap& other) const { return entries_ == other.entries_; }

  // Integral of the density from x to the sun, region included [m]; may be infinite. Cubic between entries (Hermite along
  // rows, by the map's own values; Catmull and Rom across).
  double column(const Point3& x) const;

 private:
  struct Moments {
    double f0 = 0, f1 = 0, fallen = 0;
  };
  struct Entry {
    Moments sum;
    double value;  // the map's
  };
  bool has_entries_of(const SunMap& before) const;
  void fill_row(int row, std::vector<Entry>&) const;
  Moments on_row(int row, double p) const;
  Moments at(double u, double v) const;

  const scene::Medium* medium_;
  const scene::Fogmap* fog_;
  Vec3 to_sun_;
  double step_;
  SunRows rows_;
  std::shared_ptr<const std::vector<Entry>> entries_;  // null where columns are walked
};

}  // namespace airlight::wavelet_fog
