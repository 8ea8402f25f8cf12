#include "methods/wavelet_fog/levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/base/error.h"

namespace airlight::wavelet_fog {
namespace {

using scene::HeightProfile;
using scene::MapLine;
using scene::SplineMap;

SplineMap map_of(const Coefficients& c, int degree) { return {degree, c.range, c.values}; }

}  // namespace

double integral_of_level(const SplineMap& map, int level, const HeightProfile& profile, const MapLine& line, Interval t,
                         Visits& visits) {
  long cells = 0;
  const double sum = scene::integral(map, profile, coarser(line, level), t, &cells);
  visits.cells += cells;
  visits.coefficients += cells * (map.degree() + 1) * (map.degree() + 1);
  return sum;
}

Levels make_levels(const SplineMap& map, const std::string& family_name, Coarse coarse, int levels, bool details) {
  if (levels > most_levels(map.range()))
    throw Error(fmt::format("levels = {}, expected at most {} for {} x {} coefficients", levels,
                            most_levels(map.range()), map.range().size[0], map.range().size[1]));
  Taps low;  // there is no family of degree 3: none is asked for where nothing is coarse
  if (levels > 0) low = coarse == Coarse::restricted ? restriction(map.degree()) : family(family_name).p_tilde;
  // Memory is short for large maps: free what is no longer needed before making the next copy.
  Levels result;
  Coefficients fine{map.range(), map.coefficients()};
  for (int l = 0; l < levels; ++l) {
    Coefficients next = filter_down(fine, low, low);
    Coefficients detail = details ? difference(fine, next, map.degree()) : Coefficients();
    fine = std::move(next);
    if (details) result.detail.push_back(map_of(std::exchange(detail, {}), map.degree()));
    result.grid.push_back(map_of(coarse == Coarse::clamped ? clamped(fine) : fine, map.degree()));
  }
  fine = {};
  result.grid.insert(result.grid.begin(), map);
  return result;
}

double length_in_box(const Levels& levels, const MapLine& line, double length) {
  const Interval t = clip(levels.grid.back(), coarser(line, levels.count()), {0, length});
  return t.empty() ? 0 : t.hi;
}

double composite(double depth, double behind, double fog) {
  return std::exp(-depth) * behind - std::expm1(-depth) * fog;
}

void require_share(double mu) {
  if (!(mu >= 0 && mu <= 1)) throw Error(fmt::format("mu = {}, expected 0 to 1", mu));
}

double reach_of(int m, double length, double mu) { return m == 0 ? length : length * std::pow(mu, m); }

// Algorithm 1's loop over levels, after deconstruction. Its walk over the cells of a level is walk_cells (scene/media/spline_map.h).
double summed_depth(const Levels& levels, const HeightProfile& profile, const MapLine& line, Interval inside,
                    double length, double mu, Visits& visits) {
  const int L = levels.count();
  double sum = integral_of_level(levels.grid[L], L, profile, line, intersect(inside, {0, length}), visits);
  for (int m = 1; m <= L; ++m)
    sum += integral_of_level(levels.detail[L - m], L - m, profile, line,
                             intersect(inside, {0, reach_of(m, length, mu)}), visits);
  return sum;
}

double telescoped_depth(const Levels& levels, const HeightProfile& profile, const MapLine& line, Interval inside,
                        double length, double mu, Visits& visits) {
  const int L = levels.count();
  double sum = 0, from = 0;
  for (int m = L; m >= 0; --m) {
    const double to = reach_of(m, length, mu);
    if (to > from)
      sum += integral_of_level(levels.grid[L - m], L - m, profile, line, intersect(inside, {from, to}), visits);
    from = std::max(from, to);
  }
  return sum;
}

}  // namespace airlight::wavelet_fog
