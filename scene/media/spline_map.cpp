#include "scene/media/spline_map.h"

#include "scene/media/spline_integral.h"

namespace airlight::scene {

SplineMap::SplineMap(int degree, const IndexRange& range, const std::vector<double>& coefficients)
    : degree_(degree), range_(range), stride_(range.size[0] + 2 * degree) {
  if (coefficients.empty()) return;
  padded_.assign(std::size_t(stride_) * std::size_t(range.size[1] + 2 * degree), 0);
  for (int j = 0; j < range.size[1]; ++j)
    std::copy_n(coefficients.data() + std::size_t(j) * range.size[0], range.size[0],
                padded_.data() + (j + degree) * stride_ + degree);
}

double SplineMap::coefficient(int i, int j) const {
  const int x = i - range_.lo[0], y = j - range_.lo[1];
  return x >= 0 && y >= 0 && x < range_.size[0] && y < range_.size[1] ? *cell(i, j) : 0;
}

std::vector<double> SplineMap::coefficients() const {
  std::vector<double> values(std::size_t(range_.size[0]) * range_.size[1]);
  for (int j = 0; j < range_.size[1]; ++j)
    std::copy_n(cell(range_.lo[0], range_.lo[1] + j), range_.size[0], values.data() + std::size_t(j) * range_.size[0]);
  return values;
}

double SplineMap::at(double u, double v) const {
  if (empty() || !(u >= support_lo(0) && u < support_hi(0) && v >= support_lo(1) && v < support_hi(1))) return 0;
  const int i = int(std::floor(u)), j = int(std::floor(v));
  return with_degree(degree_, [&](auto n) { return spline_integral::in_cell<n()>(cell(i, j), stride_, u - i, v - j); });
}

Interval SplineMap::bounds(const double (&lo)[2], const double (&hi)[2]) const {
  if (empty()) return {0, 0};
  int first[2], last[2];  // coefficients that reach there
  bool beyond = false;
  for (int a = 0; a < 2; ++a) {
    if (!(hi[a] >= support_lo(a) && lo[a] <= support_hi(a))) return {0, 0};
    beyond = beyond || lo[a] < support_lo(a) || hi[a] >= support_hi(a);
    // A point on a line between cells counts to both.
    const double from = std::floor(std::max(lo[a], support_lo(a))), to = std::floor(std::min(hi[a], support_hi(a)));
    first[a] = int(from) - degree_ - (from == lo[a] ? 1 : 0);
    last[a] = int(to);
    beyond = beyond || first[a] < range_.lo[a] || last[a] >= range_.lo[a] + range_.size[a];
    first[a] = std::max(first[a], range_.lo[a]);
    last[a] = std::min(last[a], range_.lo[a] + range_.size[a] - 1);
  }
  Interval bounds;
  if (beyond) bounds = {0, 0};
  for (int j = first[1]; j <= last[1]; ++j) {
    const double* row = cell(0, j);
    for (int i = first[0]; i <= last[0]; ++i) bounds = {std::min(bounds.lo, row[i]), std::max(bounds.hi, row[i])};
  }
  return bounds;
}

Interval clip(const SplineMap& map, const MapLine& line, Interval t) {
  if (map.empty()) return {};
  const double start[2] = {line.u, line.v}, step[2] = {line.du, line.dv};
  for (int a = 0; a < 2 && !t.empty(); ++a) {
    const double lo = map.support_lo(a), hi = map.support_hi(a);
    if (step[a] == 0) {
      if (!(start[a] >= lo && start[a] < hi)) return {};
      continue;
    }
    const double t0 = (lo - start[a]) / step[a], t1 = (hi - start[a]) / step[a];
    t = intersect(t, {std::min(t0, t1), std::max(t0, t1)});
  }
  return t;
}

double integral(const SplineMap& map, const HeightProfile& profile, const MapLine& line, Interval t, long* cells) {
  t = clip(map, line, t);
  if (t.empty()) return 0;
  if (std::isinf(t.hi)) {  // a vertical ray: as far as there is anything
    if (line.dy == 0) return infinity;
    const Interval heights = occupied_heights(profile);
    const double up = ((line.dy > 0 ? heights.hi : heights.lo) - line.y) / line.dy;
    if (std::isinf(up)) return map.at(line.u, line.v) > 0 ? infinity : 0;
    t.hi = up;
    if (t.empty()) return 0;
  }
  long visited = 0;
  const double sum = integral_by(map, profile, line, t, [&](Interval part, auto&& visit) {
    walk_cells(map, line, part, [&](int i, int k, double from, double to) {
      ++visited;
      visit(i, k, from, to);
      return false;
    });
  });
  if (cells) *cells += visited;
  return sum;
}

}  // namespace airlight::scene
