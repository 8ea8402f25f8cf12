#include "methods/wavelet_fog/blocks.h"

#include <algorithm>
#include <cmath>

#include "scene/media/spline_integral.h"

namespace airlight::wavelet_fog {
namespace {

using scene::HeightProfile;
using scene::MapLine;
using scene::SplineMap;

// Upwards, so that what is small is not taken for nothing.
float rounded_up(double value) { return value == 0 ? 0 : std::nextafter(float(value), infinity); }

// The fine coefficients of a coarse grid: P^level c.
Coefficients prolonged(const SplineMap& coarse, int level) {
  Coefficients c{coarse.range(), coarse.coefficients()};
  const Taps p = two_scale(coarse.degree());
  for (; level > 0; --level) {
    Coefficients fine;
    fine.range = fine_range(c.range, p);
    fine.values.assign(std::size_t(fine.range.size[0]) * fine.range.size[1], 0);
    filter_up(c, p, p, fine);
    c = std::move(fine);
  }
  return c;
}

// Calls visit(i, j, level, from, to) along the line, until it returns true: choose(i, j) names the level of the block around
// a cell, which is passed at once.
template <class Choose, class Visit>
void walk_blocks(const SplineMap& map, const MapLine& line, Interval t, Choose&& choose, Visit&& visit) {
  t = clip(map, line, t);
  if (t.empty()) return;
  const double start[2] = {line.u, line.v}, step[2] = {line.du, line.dv};
  const int least[2] = {map.range().lo[0], map.range().lo[1]};
  const int last[2] = {int(map.support_hi(0)) - 1, int(map.support_hi(1)) - 1};
  double next[2] = {0, 0}, at[2] = {infinity, infinity};  // the next grid line, and where it is met
  const auto look = [&](int a) { at[a] = (next[a] - start[a]) / step[a]; };
  // The first grid line beyond `from`.
  const auto find_lines = [&](double from) {
    for (int a = 0; a < 2; ++a) {
      if (step[a] == 0) continue;
      const double here = start[a] + from * step[a];
      next[a] = step[a] > 0 ? std::floor(here) + 1 : std::ceil(here) - 1;
      for (look(a); !(at[a] > from); look(a)) next[a] += step[a] > 0 ? 1 : -1;
    }
  };
  find_lines(t.lo);
  for (double from = t.lo; from < t.hi;) {
    double to = std::min({at[0], at[1], t.hi});
    int cell[2];
    for (int a = 0; a < 2; ++a)
      cell[a] = std::clamp(int(std::floor(start[a] + 0.5 * (from + to) * step[a])), least[a], last[a]);
    const int level = choose(cell[0], cell[1]);
    if (level > 0) {
      double exit = t.hi;
      for (int a = 0; a < 2; ++a) {
        if (step[a] == 0) continue;
        const int block = cell[a] >> level;
        exit = std::min(exit, (std::ldexp(double(step[a] > 0 ? block + 1 : block), level) - start[a]) / step[a]);
      }
      to = std::max(to, exit);
    }
    if (visit(cell[0], cell[1], level, from, to)) return;
    from = to;
    if (level > 0) {
      find_lines(from);
      continue;
    }
    for (int a = 0; a < 2; ++a) {
      if (at[a] > from) continue;
      next[a] += step[a] > 0 ? 1 : -1;
      look(a);
    }
  }
}

}  // namespace

std::size_t Blocks::index(const Level& l, int level, int i, int j) {
  return std::size_t((j >> level) - l.lo[1]) * l.size[0] + std::size_t((i >> level) - l.lo[0]);
}

Blocks::Blocks(const Levels& levels, int most_level, bool errors) {
  const SplineMap& map = levels.grid[0];
  const int n = map.degree();
  for (int l = 0; l <= most_level; ++l) {
    Level of;
    for (int a = 0; a < 2; ++a) {
      of.lo[a] = map.range().lo[a] >> l;
      of.size[a] = ((int(map.support_hi(a)) - 1) >> l) - of.lo[a] + 1;
    }
    of.greatest.assign(std::size_t(of.size[0]) * of.size[1], 0);
    // Coefficient (i, j) reaches cells i to i + n.
    const auto spread = [&](std::vector<float>& to, int i, int j, double value) {
      const float up = rounded_up(std::abs(value));
      for (int y = std::max((j >> l), of.lo[1]); y <= std::min((j + n) >> l, of.lo[1] + of.size[1] - 1); ++y)
        for (int x = std::max((i >> l), of.lo[0]); x <= std::min((i + n) >> l, of.lo[0] + of.size[0] - 1); ++x) {
          float& cell = to[std::size_t(y - of.lo[1]) * of.size[0] + std::size_t(x - of.lo[0])];
          cell = std::max(cell, up);
        }
    };
    for (int j = 0; j < map.range().size[1]; ++j)
      for (int i = 0; i < map.range().size[0]; ++i) {
        const int x = map.range().lo[0] + i, y = map.range().lo[1] + j;
        spread(of.greatest, x, y, map.coefficient(x, y));
      }
    if (errors && l > 0) {
      of.error.assign(of.greatest.size(), 0);
      const Coefficients fine = prolonged(levels.grid[l], l);
      for (int j = 0; j < fine.range.size[1]; ++j)
        for (int i = 0; i < fine.range.size[0]; ++i) {
          const int x = fine.range.lo[0] + i, y = fine.range.lo[1] + j;
          spread(of.error, x, y, map.coefficient(x, y) - fine.values[std::size_t(j) * fine.range.size[0] + i]);
        }
    }
    level_.push_back(std::move(of));
  }
}

int Blocks::empty_level(int i, int j) const {
  int level = -1;
  while (level < most_level() && level_[level + 1].greatest[index(level_[level + 1], level + 1, i, j)] == 0) ++level;
  return level;
}

int Blocks::level_within(int i, int j, double most) const {
  int level = most_level();
  while (level > 0 && !(level_[level].error[index(level_[level], level, i, j)] <= most)) --level;
  return level;
}

double skipped_depth(const Levels& levels, const Blocks& blocks, const HeightProfile& profile, const MapLine& line,
                     Interval t, double enough, Visits& visits) {
  const SplineMap& map = levels.grid[0];
  t = clip(map, line, t);
  if (t.empty()) return 0;
  const int terms = (map.degree() + 1) * (map.degree() + 1);
  bool full = false;
  return scene::integral_by(map, profile, line, t, [&](Interval part, auto&& add) {
    if (full) return;
    walk_blocks(
        map, line, part, [&](int i, int j) { return blocks.empty_level(i, j); },
        [&](int i, int j, int level, double from, double to) {
          if (level >= 0) return false;
          ++visits.cells;
          visits.coefficients += terms;
          return full = add(i, j, from, to) > enough;
        });
  });
}

double bounded_depth(const Levels& levels, const Blocks& blocks, const HeightProfile& profile, const MapLine& line,
                     Interval t, double most, double enough, Visits& visits) {
  constexpr int most_blocks = 8;  // between two looks at `enough`
  double sum = 0;
  Interval run;  // of blocks of one level
  int run_level = 0, run_blocks = 0;
  bool empty = false;
  const auto add_run = [&] {
    if (!run.empty()) sum += integral_of_level(levels.grid[run_level], run_level, profile, line, run, visits);
    run = {};
    run_blocks = 0;
  };
  walk_blocks(
      levels.grid[0], line, t,
      [&](int i, int j) {
        const int nothing = blocks.empty_level(i, j);
        empty = nothing >= 0;
        return empty ? nothing : blocks.level_within(i, j, most);
      },
      [&](int, int, int level, double from, double to) {
        if (empty || level != run_level || run_blocks == most_blocks) add_run();
        if (!empty) {
          run = {run.empty() ? from : run.lo, to};
          run_level = level;
          ++run_blocks;
        }
        return sum > enough;
      });
  add_run();
  return sum;
}

}  // namespace airlight::wavelet_fog
