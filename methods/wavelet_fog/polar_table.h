// Integrals of the map from the eye, by angle and distance over the ground, tabulated once per frame: where the height's
// factor is 1 or made of straight lines, every ray from the eye is a lookup.
//
// Along a ray f depends on the place over the ground alone, so that its integral from the eye is that of the horizontal
// ray, stretched. A factor alpha + beta s, s the distance over the ground, takes the integral of s f as well.
#pragma once
#include <vector>

#include "scene/media/fogmap.h"
#include "scene/renderer.h"

namespace airlight::wavelet_fog {

class PolarTable {
 public:
  struct Moments {
    double f = 0;    // integral of f ds [cells]
    double s_f = 0;  // of s f ds [cells^2]; 0 unless asked for
  };
  // Directions over the map: from angle `first` [rad, of (cos, sin) along u and v] over `span`, 2 pi for all.
  struct Fan {
    double first = 0, span = 0;
  };
  // From (u, v) of the map. `angles` over the fan, a distance of `step` cells between entries.
  PolarTable(const scene::SplineMap&, double u, double v, const Fan&, int angles, double step, bool with_first_moment,
             const scene::Execution&);

  // Up to r cells in the direction (du, dv), of any length but 0, in the fan. Cubic in the angle (Catmull and Rom) and in the distance
  // (Hermite, by the map's own values).
  Moments at(double du, double dv, double r) const { return at(place(du, dv), r); }
  // A direction, found once for lookups at many distances.
  struct Place {
    int first;  // of the four spokes around the direction
    double t;   // from the second to the third of them, in [0, 1]
  };
  Place place(double du, double dv) const;
  Moments at(const Place&, double r) const;
  double reach() const { return (first_ + steps_) * step_; }  // [cells], beyond the map: nothing is added farther out
  long cells() const { return cells_; }                       // visited for the table

 private:
  struct Entry {
    double f, s_f, value;  // integrals up to here, and the map here
  };

  Fan fan_;
  int angles_, first_, steps_;  // the first entry lies `first_` steps from the eye: nothing is nearer
  double spacing_;              // of angles; the first spoke lies one before the fan
  double step_;
  double per_spacing_, per_step_;  // their inverses
  bool first_moment_;
  long cells_ = 0;
  std::vector<Entry> entries_;  // [angle][distance]
};

// Directions over the map that a view holds. Where it looks straight up or down anywhere, all of them; else they are widest at its
// rim. From an eye beside the map no more than the map takes, and a few of the `angles` of the fan to both sides.
PolarTable::Fan fan_of(const scene::Fogmap&, const scene::View&, int angles);

// Entries of a spoke from (u, v), in steps of that many cells: from the last before the map, 0 within it, to the first that passes its
// farthest corner. Throws Error, which names the settings, where a table of so many angles is larger than `most_table_bytes`.
inline constexpr double most_table_bytes = 4e9;
struct Spoke {
  int first = 0, steps = 0;
};
Spoke spoke_of(const scene::SplineMap&, double u, double v, int angles, double step);

}  // namespace airlight::wavelet_fog
