#include "scene/media/legendre_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/legendre_range.h"
#include "scene/media/legendre_line.h"
#include "scene/media/region.h"

namespace airlight::scene {
namespace {

double greatest_value(const Eigen::VectorXd& series, const TensorShape& shape, double rounding) {
  const GreatestValue value = legendre_greatest(series, shape, [&](const GreatestValue& v) {
    return v.bound + rounding <= 0 || v.bound - v.found <= 0.01 * v.found + rounding;
  });
  return std::max(0.0, value.bound + rounding);
}

bool exceeds_zero(const Eigen::VectorXd& series, const TensorShape& shape, double rounding) {
  const GreatestValue value =
      legendre_greatest(series, shape, [&](const GreatestValue& v) { return v.found > 0 || v.bound + rounding <= 0; });
  return value.bound + rounding > 0;
}

}  // namespace

LegendreBox::LegendreBox(const Box& box, const TensorShape& shape, Eigen::VectorXd coefficients)
    : box_(box), shape_(shape), coefficients_(std::move(coefficients)) {
  for (const int n : shape)
    if (n < 1 || n > most)
      throw Error(fmt::format("a Legendre box with {} coefficients along an axis, expected 1 to {}", n, most));
  if (coefficients_.size() != tensor_size(shape))
    throw Error(fmt::format("a Legendre box with {} coefficients, expected {} x {} x {}", coefficients_.size(),
                            shape[0], shape[1], shape[2]));
  if (!coefficients_.allFinite()) throw Error("a Legendre box with a coefficient that is not finite");
  if (!(box.size().array() > 0).all() || !box.size().allFinite()) throw Error("a Legendre box without positive sides");
  rounding_ = 4e-16 * (shape[0] + shape[1] + shape[2]) * legendre_bound(coefficients_, shape);
  greatest_ = greatest_value(coefficients_, shape, rounding_);
  negative_ = greatest_ > 0 && exceeds_zero(-coefficients_, shape, rounding_);
}

Point3 LegendreBox::local(const Point3& x) const { return ((x - box_.lo) - (box_.hi - x)).cwiseQuotient(box_.size()); }

double LegendreBox::value(const Point3& local) const {
  std::array<double, most> x, y, z;
  legendre_values_at(shape_[0], local[0], x.data());
  legendre_values_at(shape_[1], local[1], y.data());
  legendre_values_at(shape_[2], local[2], z.data());
  const double* c = coefficients_.data();
  double sum = 0;
  for (int i = 0; i < shape_[0]; ++i) {
    double plane = 0;
    for (int j = 0; j < shape_[1]; ++j) {
      double row = 0;
      for (int k = 0; k < shape_[2]; ++k) row += c[k] * z[std::size_t(k)];
      plane += row * y[std::size_t(j)];
      c += shape_[2];
    }
    sum += plane * x[std::size_t(i)];
  }
  return sum;
}

double density(const LegendreBox& field, const Point3& x) {
  return field.box().contains(x) ? std::max(0.0, field.value(field.local(x))) : 0;
}

Interval density_bounds(const LegendreBox& field, const Box& where) {
  const Box inside = intersect(where, field.box());
  if (inside.empty() || field.greatest() == 0) return {0, 0};
  std::array<Eigen::MatrixXd, 3> part;
  const Point3 lo = field.local(inside.lo), hi = field.local(inside.hi);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = Eigen::Index(axis);
    part[axis] = legendre_restriction(field.shape()[axis], lo[a], hi[a]);
  }
  const Interval range =
      legendre_range(along_axes(part[0], part[1], part[2], field.coefficients(), field.shape()), field.shape());
  const double greatest = std::clamp(range.hi + field.rounding(), 0.0, field.greatest());
  const bool whole = field.box().contains(where.lo) && field.box().contains(where.hi);
  return {whole ? std::clamp(range.lo - field.rounding(), 0.0, greatest) : 0, greatest};
}

double density_integral(const LegendreBox& field, const Ray& ray, Interval t) {
  t = extent(field, ray, t);
  return t.empty() ? 0 : LegendreLine(field, ray, t).integral(t.hi);
}

Interval extent(const LegendreBox& field, const Ray& ray, Interval t) {
  if (field.greatest() == 0) return {};
  t = clip(field.box(), ray, t);
  return t.empty() ? Interval{} : t;
}

Box support(const LegendreBox& field) { return field.greatest() > 0 ? field.box() : Box{}; }

}  // namespace airlight::scene
