// A function on the plane as a sum of B-splines: f(u, v) = sum_ij c_ij N_n(u - i) N_n(v - j), 0 outside its support.
// Giroud and Biri 2010, section 3.
//
// Exact integrals along straight lines: within a cell f is a polynomial of degree 2 n of the line's parameter, so that
// n + 1 Gauss points integrate it, also times a factor that is linear in height.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/math/bspline.h"
#include "scene/media/height_profile.h"

namespace airlight::scene {

// Indices of coefficients: [lo, lo + size) along u and v.
struct IndexRange {
  int lo[2] = {0, 0};
  int size[2] = {0, 0};  // >= 1, or 0 for no coefficients at all
};

class SplineMap {
 public:
  SplineMap() = default;
  // `coefficients` has range.size[0] * range.size[1] values, u fastest; of any sign, finite. degree: 0 to 3.
  SplineMap(int degree, const IndexRange& range, const std::vector<double>& coefficients);

  int degree() const { return degree_; }
  const IndexRange& range() const { return range_; }
  bool empty() const { return padded_.empty(); }
  // f is 0 outside [lo, hi) of u (axis 0) and of v (axis 1).
  double support_lo(int axis) const { return range_.lo[axis]; }
  double support_hi(int axis) const { return range_.lo[axis] + range_.size[axis] + degree_; }

  double coefficient(int i, int j) const;  // 0 outside the range
  std::vector<double> coefficients() const;
  double at(double u, double v) const;
  // Bounds of f over [lo, hi] of u and v: rigorous (the convex hull of the coefficients that reach there).
  Interval bounds(const double (&lo)[2], const double (&hi)[2]) const;

  // The coefficient of cell (i, j) of the support; that m columns and k rows before it stands at [-m - k * stride()].
  const double* cell(int i, int j) const {
    return padded_.data() + (j - range_.lo[1] + degree_) * stride_ + (i - range_.lo[0] + degree_);
  }
  std::ptrdiff_t stride() const { return stride_; }

 private:
  int degree_ = 0;
  IndexRange range_;
  std::ptrdiff_t stride_ = 0;
  std::vector<double> padded_;  // with n zeros on every side, so that cells at the border are like the others
};

// Where a ray is over a map: u + t du, v + t dv [cells], at height y + t dy [m].
struct MapLine {
  double u, v, y;
  double du, dv, dy;
};

// The line over the same map with cells 2^level times as large.
inline MapLine coarser(const MapLine& line, int level) {
  const double s = std::ldexp(1.0, -level);
  return {line.u * s, line.v * s, line.y, line.du * s, line.dv * s, line.dy};
}

// The part of t over the support.
Interval clip(const SplineMap&, const MapLine&, Interval t);

// Integral of f times the height's factor over t [unit of t]; adds the cells that were visited. Error 1e-15 (double
// rounding); exponential heights to the same, by n + 6 points in pieces of at most one scale height.
double integral(const SplineMap&, const HeightProfile&, const MapLine&, Interval t, long* cells = nullptr);

// Visits the cells that the line crosses in order, t ascending: visit(i, j, t0, t1), until it returns true. A corner is
// passed at once; parameters of grid lines come from their indices, nothing accumulates.
template <class Visit>
void walk_cells(const SplineMap& map, const MapLine& line, Interval t, Visit&& visit) {
  t = clip(map, line, t);
  if (t.empty()) return;
  const double start[2] = {line.u, line.v}, step[2] = {line.du, line.dv};
  double next[2] = {0, 0}, at[2];  // the next grid line, and where it is met
  const auto look = [&](int a) { at[a] = (next[a] - start[a]) / step[a]; };
  for (int a = 0; a < 2; ++a) {
    at[a] = infinity;
    if (step[a] == 0) continue;
    const double here = start[a] + t.lo * step[a];
    next[a] = step[a] > 0 ? std::floor(here) + 1 : std::ceil(here) - 1;
    look(a);
  }
  const int least[2] = {map.range().lo[0], map.range().lo[1]};
  const int last[2] = {int(map.support_hi(0)) - 1, int(map.support_hi(1)) - 1};
  for (double from = t.lo; from < t.hi;) {
    const double to = std::min({at[0], at[1], t.hi});
    if (to > from) {
      const double middle = 0.5 * (from + to);
      int cell[2];
      for (int a = 0; a < 2; ++a) cell[a] = std::clamp(int(std::floor(start[a] + middle * step[a])), least[a], last[a]);
      if (visit(cell[0], cell[1], from, to)) return;
      from = to;
    }
    for (int a = 0; a < 2; ++a) {
      if (at[a] > from) continue;
      next[a] += step[a] > 0 ? 1 : -1;
      look(a);
    }
  }
}

}  // namespace airlight::scene
