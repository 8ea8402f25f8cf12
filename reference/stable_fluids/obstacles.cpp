#include "reference/stable_fluids/obstacles.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "scene/base/error.h"
#include "scene/geometry/geometry.h"

namespace airlight::stable_fluids {
namespace {

using Solids = Field<std::uint8_t>;

// Cells whose centre is crossed into more often than out of, along x, for each shape is closed. How many.
std::size_t mark(const scene::Surface& surface, const Lattice& l, Solids& solid) {
  const scene::Geometry shape({surface});
  const Box bounds = shape.bounds();
  std::atomic<std::size_t> marked = 0;
  for_rows(solid.n, [&](int j, int k) {
    const Point3 first = solid.position(l, 0, j, k);
    if (bounds.hi[1] < first[1] || bounds.lo[1] > first[1] || bounds.hi[2] < first[2] || bounds.lo[2] > first[2])
      return;
    const double start = std::min(first[0], bounds.lo[0]) - l.h;
    const auto hits = shape.all_hits({Point3(start, first[1], first[2]), Vec3::UnitX()});
    std::size_t passed = 0, in_row = 0;
    for (int i = 0; i < solid.n[0]; ++i) {
      const double x = solid.position(l, i, j, k)[0];
      while (passed < hits.size() && hits[passed].position[0] <= x) ++passed;
      if (passed % 2 == 0) continue;
      solid.at(i, j, k) = 1;
      ++in_row;
    }
    marked += in_row;
  });
  return marked;
}

// Beyond a side: what is there is what is mirrored, or wraps.
void continue_beyond(const Lattice& l, Solids& solid) {
  const auto inside = [&](int i, int axis) {
    const int n = l.n[axis];
    if (l.periodic(axis)) return ((i % n) + n) % n;
    return std::clamp(i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i, 0, n - 1);
  };
  for (int k = -solid.margin[2]; k < l.n[2] + solid.margin[2]; ++k)
    for (int j = -solid.margin[1]; j < l.n[1] + solid.margin[1]; ++j)
      for (int i = -solid.margin[0]; i < l.n[0] + solid.margin[0]; ++i)
        solid.at(i, j, k) = solid.at(inside(i, 0), inside(j, 1), inside(k, 2));
}

// By growing what is solid, a layer at a time along each axis.
std::vector<std::uint8_t> clear_cells(const Lattice& l, const Solids& solid) {
  constexpr int most = 15;  // a way that is longer is followed from cell to cell
  std::vector<std::uint8_t> clear(count_of(l.n), most);
  Solids grown = solid;
  for (int layer = 0; layer <= most; ++layer) {
    for_rows(l.n, [&](int j, int k) {
      std::uint8_t* row = clear.data() + std::size_t(l.n[0]) * (j + std::size_t(l.n[1]) * k);
      for (int i = 0; i < l.n[0]; ++i)
        if (grown.at(i, j, k) && row[i] == most) row[i] = std::uint8_t(std::max(0, layer - 1));
    });
    for (int a = 0; a < l.dimensions; ++a) {
      continue_beyond(l, grown);
      const Solids before = grown;
      for_rows(l.n, [&](int j, int k) {
        for (int i = 0; i < l.n[0]; ++i) {
          const std::uint8_t* at = before.row(j, k) + i;
          grown.at(i, j, k) = at[0] | at[before.stride[a]] | at[-before.stride[a]];
        }
      });
    }
  }
  return clear;
}

}  // namespace

Obstacles make_obstacles(const scene::FlowProblem& problem, const Lattice& l) {
  Obstacles obstacles;
  if (problem.obstacles.empty()) return obstacles;
  obstacles.solid = Solids(l, at_centers);
  for (std::size_t i = 0; i < problem.obstacles.size(); ++i)
    if (mark(problem.obstacles[i], l, obstacles.solid) == 0)
      throw Error(fmt::format(
          "obstacle {}: the centre of no cell of {:.4g} m lies in it, expected a thicker one or more cells", i, l.h));
  for (int k = 0; k < l.n[2]; ++k)
    for (int j = 0; j < l.n[1]; ++j)
      obstacles.count += std::size_t(std::count(obstacles.solid.row(j, k), obstacles.solid.row(j, k) + l.n[0], 1));
  if (obstacles.count == count_of(l.n)) throw Error("the obstacles fill the box: no cell of fluid is left");
  continue_beyond(l, obstacles.solid);
  obstacles.clear = clear_cells(l, obstacles.solid);
  return obstacles;
}

template <class Real>
bool beside_solid(const Obstacles& obstacles, const Field<Real>& component, int i, int j, int k) {
  const std::uint8_t* after = obstacles.solid.row(j, k) + i;
  return *after != 0 || after[-obstacles.solid.stride[component.axis]] != 0;
}

template <class Real>
void stop_at_obstacles(const Obstacles& obstacles, Field<Real>& component) {
  if (!obstacles.any()) return;
  for_rows(component.n, [&](int j, int k) {
    for (int i = 0; i < component.n[0]; ++i)
      if (beside_solid(obstacles, component, i, j, k)) component.at(i, j, k) = 0;
  });
}

// From cell to cell along the line: Amanatides and Woo 1987.
Vec3 until_solid(const Obstacles& obstacles, const Lattice& l, const Vec3& from, const Vec3& to) {
  int cell[3] = {0, 0, 0}, step[3] = {0, 0, 0};
  double next[3], each[3];
  const Vec3 way = to - from;
  const auto wrapped = [&](int a) { return l.periodic(a) ? ((cell[a] % l.n[a]) + l.n[a]) % l.n[a] : cell[a]; };
  for (int a = 0; a < 3; ++a) {
    next[a] = each[a] = infinity;
    if (a >= l.dimensions) continue;
    cell[a] = int(std::floor(from[a]));
    if (way[a] < 0 && from[a] == cell[a]) --cell[a];  // on a face: the cell that is entered
    if (!l.periodic(a)) cell[a] = std::clamp(cell[a], 0, l.n[a] - 1);
    if (way[a] == 0) continue;
    step[a] = way[a] > 0 ? 1 : -1;
    each[a] = 1 / std::abs(way[a]);
    next[a] = ((way[a] > 0 ? cell[a] + 1 : cell[a]) - from[a]) / way[a];
  }
  double entered = 0;
  // A way that goes around a periodic box for ever ends somewhere.
  for (int passed = 0; passed < 100'000; ++passed) {
    if (obstacles.solid.at(wrapped(0), wrapped(1), wrapped(2))) return from + entered * way;
    const int a = int(std::min_element(next, next + 3) - next);
    if (!(next[a] < 1)) return to;
    entered = next[a];
    next[a] += each[a];
    cell[a] += step[a];
    if (!l.periodic(a) && (cell[a] < 0 || cell[a] >= l.n[a])) return from + entered * way;
  }
  return from + entered * way;
}

template bool beside_solid(const Obstacles&, const Field<float>&, int, int, int);
template bool beside_solid(const Obstacles&, const Field<double>&, int, int, int);
template void stop_at_obstacles(const Obstacles&, Field<float>&);
template void stop_at_obstacles(const Obstacles&, Field<double>&);

}  // namespace airlight::stable_fluids
