// Upper bounds of a density field, constant on the cells of a coarse grid ("supergrid": Szirmay-Kalos et al. 2011).
//
// The grid spans a box; outside it, where the field is unbounded, one more bound holds. Bounds are floats rounded up.
#pragma once
#include <functional>
#include <vector>

#include "scene/math/types.h"
#include "scene/media/grid_steps.h"

namespace airlight::path_tracer {

struct Supergrid {
  Point3 lo = Point3::Zero();     // corner of the first cell
  Vec3 cell = Vec3::Ones();       // [m] or samples: size of a cell
  Eigen::Vector3i size{0, 0, 0};  // cells per axis; 0: no cells, `outside` holds everywhere
  std::vector<float> majorants;   // x fastest
  float outside = 0;              // bound of the density beyond the box

  float at(int i, int j, int k) const { return majorants[i + std::size_t(size[0]) * (j + std::size_t(size[1]) * k)]; }
  Box box() const { return {lo, lo + cell.cwiseProduct(size.cast<double>())}; }
  // The cell at x, as an index into `majorants`; -1 outside the box. Rounding may give the neighbour at a face.
  std::ptrdiff_t cell_at(const Point3& x) const {
    const Vec3 at = (x - lo).cwiseQuotient(cell);
    if (!(at.minCoeff() >= 0) || !(at.array() < size.cast<double>().array()).all()) return -1;
    return int(at[0]) + std::ptrdiff_t(size[0]) * (int(at[1]) + std::ptrdiff_t(size[1]) * int(at[2]));
  }
  // A cell, widened by a few ulp of the box: a point that rounding puts on the wrong side of a face lies in it.
  Box widened_cell(int i, int j, int k) const;
};

// `bound` gives an upper bound of the density over a box, here over the widened cells.
Supergrid make_supergrid(const Box& box, const Eigen::Vector3i& cells, double scale,
                         const std::function<double(const Box&)>& bound);

// The least float that is not below x.
float round_up(double x);

// Calls visit(t0, t1, majorant) for the pieces of [t.lo, t.hi] of the ray in order, each with its bound, until visit
// returns true.
template <class Visit>
void walk(const Supergrid& grid, const Ray& ray, Interval t, Visit&& visit) {
  double inside_begin = t.lo, inside_end = t.lo;
  if (grid.size[0] > 0) {
    const Box box = grid.box();
    inside_end = t.hi;
    for (int a = 0; a < 3; ++a) {
      if (ray.direction[a] == 0) {
        if (!(ray.origin[a] >= box.lo[a] && ray.origin[a] <= box.hi[a])) inside_end = -infinity;
        continue;
      }
      const double t0 = (box.lo[a] - ray.origin[a]) / ray.direction[a];
      const double t1 = (box.hi[a] - ray.origin[a]) / ray.direction[a];
      inside_begin = std::max(inside_begin, std::min(t0, t1));
      inside_end = std::min(inside_end, std::max(t0, t1));
    }
  }
  if (!(inside_begin < inside_end)) {
    visit(t.lo, t.hi, double(grid.outside));
    return;
  }
  if (inside_begin > t.lo && visit(t.lo, inside_begin, double(grid.outside))) return;

  const std::ptrdiff_t row = grid.size[0];
  const Point3 most = grid.size.cast<double>().array() - 1;
  const Ray in_cells{(ray.origin - grid.lo).cwiseQuotient(grid.cell), ray.direction.cwiseQuotient(grid.cell)};
  scene::GridSteps steps(in_cells, inside_begin, Point3::Zero(), most, {1, row, row * grid.size[1]});
  const __m256d none = _mm256_setzero_pd(), last = scene::GridSteps::lanes(most, 0);
  double now = inside_begin;
  double majorant = grid.majorants[steps.index()];
  for (;; steps.advance()) {
    // Rounding may lead out of the cells a few ulp early: the rest of the way in the box keeps the last bound.
    if (!steps.within(none, last)) break;
    majorant = grid.majorants[steps.index()];
    const double exit = std::min(std::max(steps.exit(), now), inside_end);
    if (exit > now && visit(now, exit, majorant)) return;
    now = exit;
    if (!(now < inside_end)) break;
  }
  if (now < inside_end && visit(now, inside_end, majorant)) return;
  if (inside_end < t.hi) visit(inside_end, t.hi, double(grid.outside));
}

}  // namespace airlight::path_tracer
