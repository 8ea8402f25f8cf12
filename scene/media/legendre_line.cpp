#include "scene/media/legendre_line.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/math/legendre_range.h"
#include "scene/math/legendre_series.h"

namespace airlight::scene {
namespace {

// Where a series that is monotone, of different signs at -1 and 1, passes 0: Newton's steps, halves where they leave what encloses the root.
double only_root(const Eigen::VectorXd& series, const Eigen::VectorXd& slope, bool rises) {
  double lo = -1, hi = 1, x = 0;
  for (int step = 0; step < 100 && x > lo && x < hi; ++step) {
    const double value = series_value(series, x);
    if (value == 0) return x;
    ((value > 0) == rises ? hi : lo) = x;
    const double next = x - value / series_value(slope, x);
    if (std::abs(next - x) <= 1e-15) return std::clamp(next, lo, hi);
    x = next > lo && next < hi ? next : 0.5 * (lo + hi);
  }
  return x;
}

// The polynomial at places of the range, given as ones of [-1, 1]: summed along z for all of them at once.
Eigen::VectorXd values_on(const LegendreBox& field, const Ray& ray, Interval t, const Eigen::VectorXd& places) {
  std::array<Eigen::VectorXd, 3> local;
  for (Eigen::VectorXd& coordinate : local) coordinate.resize(places.size());
  for (Eigen::Index p = 0; p < places.size(); ++p) {
    const double s = 0.5 * (1 + places[p]);
    const Point3 x = field.local(ray.at((1 - s) * t.lo + s * t.hi));
    for (std::size_t axis = 0; axis < 3; ++axis) local[axis][p] = x[Eigen::Index(axis)];
  }
  const auto [nx, ny, nz] = field.shape();
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Rows> coefficients(field.coefficients().data(), nx * ny, nz);
  const Eigen::MatrixXd planes = coefficients * legendre_values(nz, local[2]).transpose();
  const Eigen::MatrixXd x = legendre_values(nx, local[0]), y = legendre_values(ny, local[1]);
  Eigen::VectorXd values(places.size());
  for (Eigen::Index p = 0; p < places.size(); ++p) {
    const Eigen::VectorXd along_x = Eigen::Map<const Rows>(planes.col(p).data(), nx, ny) * y.row(p).transpose();
    values[p] = x.row(p).dot(along_x);
  }
  return values;
}

}  // namespace

LegendreLine::LegendreLine(const LegendreBox& field, const Ray& ray, Interval t)
    : range_(t), rounding_(field.rounding()) {
  int degree = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (ray.direction[Eigen::Index(axis)] != 0) degree += field.shape()[axis] - 1;
  const LegendrePoints& points = legendre_points(degree + 1);
  series_ = points.analysis * values_on(field, ray, t, points.node);
  // Half the range converts the integral over [-1, 1] to world units.
  primitive_ = 0.5 * t.length() * series_primitive(series_);
  if (field.negative())
    isolate(series_, t);
  else
    add(t);
}

double LegendreLine::density(double t) const { return std::max(0.0, series_value(series_, to_local(t))); }

double LegendreLine::primitive(double t) const { return series_value(primitive_, to_local(t)); }

double LegendreLine::integral(double t) const {
  const auto after =
      std::upper_bound(positive_.begin(), positive_.end(), t, [](double x, const Interval& p) { return x < p.lo; });
  if (after == positive_.begin()) return 0;
  const auto last = std::size_t(after - positive_.begin()) - 1;
  const Interval& piece = positive_[last];
  return before_[last] + std::max(0.0, primitive(std::min(t, piece.hi)) - primitive(piece.lo));
}

void LegendreLine::add(Interval t) {
  if (!positive_.empty() && positive_.back().hi == t.lo) {
    positive_.back().hi = t.hi;
    return;
  }
  before_.push_back(positive_.empty() ? 0 : integral(positive_.back().hi));
  positive_.push_back(t);
}

void LegendreLine::isolate(const Eigen::VectorXd& series, Interval t) {
  const Interval range = legendre_range(series);
  if (range.hi <= 0) return;
  if (range.lo >= 0) return add(t);
  const double middle = 0.5 * (t.lo + t.hi), most = std::max(range.hi, -range.lo);
  if (most <= rounding_ || most * t.length() <= rounding_ * range_.length() || !(middle > t.lo && middle < t.hi)) {
    if (series[0] > 0) add(t);  // positive or negative on the whole: no one can tell
    return;
  }
  const Eigen::VectorXd slopes = series_slope(series);
  const Interval slope = legendre_range(slopes);
  if (slope.lo >= 0 || slope.hi <= 0) {  // monotone: one root at most
    const bool rises = slope.lo >= 0;
    const double first = series_value(series, -1), last = series_value(series, 1);
    if (first <= 0 && last <= 0) return;
    if (first >= 0 && last >= 0) return add(t);
    const double root = t.lo + 0.5 * (1 + only_root(series, slopes, rises)) * t.length();
    return add(rises ? Interval{root, t.hi} : Interval{t.lo, root});
  }
  isolate(series_half(series, false), {t.lo, middle});
  isolate(series_half(series, true), {middle, t.hi});
}

}  // namespace airlight::scene
