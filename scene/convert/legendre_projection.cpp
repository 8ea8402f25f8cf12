#include "scene/convert/legendre_projection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/legendre_range.h"
#include "scene/media/legendre_box.h"

namespace airlight::scene {
namespace {

constexpr int most_cells = 48;   // 1.4e7 densities at 240 places an axis
constexpr double margin = 1e-3;  // of the mean, that the limiter leaves

// A composite Gauss rule on [-1, 1].
struct Rule {
  Eigen::VectorXd node, weight;
};
Rule composite(int cells, int points) {
  const GaussLegendre gauss = gauss_legendre(points);
  Rule rule{Eigen::VectorXd(cells * points), Eigen::VectorXd(cells * points)};
  for (int c = 0; c < cells; ++c)
    for (int p = 0; p < points; ++p) {
      rule.node[c * points + p] = -1 + (2 * c + 1 + gauss.node[std::size_t(p)]) / cells;
      rule.weight[c * points + p] = gauss.weight[std::size_t(p)] / cells;
    }
  return rule;
}

Point3 world(const Box& box, double u, double v, double w) {
  return box.center() + 0.5 * box.size().cwiseProduct(Vec3(u, v, w));
}

// Densities on the product of the rule with itself, [x][y][z].
Eigen::VectorXd sampled(const Medium& medium, const Box& box, const Rule& rule) {
  const Eigen::Index n = rule.node.size();
  Eigen::VectorXd values(n * n * n);
  Eigen::Index at = 0;
  for (const double u : rule.node)
    for (const double v : rule.node)
      for (const double w : rule.node) values[at++] = density(medium, world(box, u, v, w));
  return values;
}

double lanczos(int k, int n) { return k == 0 ? 1 : std::sin(pi * k / n) / (pi * k / n); }

Eigen::VectorXd projected(const Medium& medium, const Box& box, const ProjectionOptions& options) {
  const Rule rule = composite(options.cells, 4);
  std::array<Eigen::MatrixXd, 3> analysis;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int n = options.shape[axis];
    analysis[axis] = legendre_values(n, rule.node).transpose() * rule.weight.asDiagonal();
    for (int k = 0; k < n && options.lanczos; ++k) analysis[axis].row(k) *= lanczos(k, n);
  }
  const int m = int(rule.node.size());
  return along_axes(analysis[0], analysis[1], analysis[2], sampled(medium, box, rule), {m, m, m});
}

Interval extremes(const Eigen::VectorXd& series, const TensorShape& shape) {
  const auto close = [](const GreatestValue& v) { return v.bound - v.found <= 0.01 * std::abs(v.found); };
  return {-legendre_greatest(-series, shape, close).bound, legendre_greatest(series, shape, close).bound};
}

// The factor on all coefficients but the first.
double limited(Eigen::VectorXd& series, const TensorShape& shape) {
  const double mean = series[0] / std::sqrt(8.0), least = extremes(series, shape).lo;
  if (!(mean > 0) || least >= 0) return 1;
  const double theta = std::min(1.0, (1 - margin) * mean / (mean - least));
  series.tail(series.size() - 1) *= theta;
  return theta;
}

// Compares at points of another rule.
void measure(LegendreProjection& result, const Medium& medium, int cells) {
  const LegendreBox& field = *result.field;
  const Rule rule = composite(cells, 5);
  const Eigen::VectorXd exact = sampled(medium, field.box(), rule);
  std::array<Eigen::MatrixXd, 3> values;
  for (std::size_t axis = 0; axis < 3; ++axis) values[axis] = legendre_values(field.shape()[axis], rule.node);
  const Eigen::VectorXd ours = along_axes(values[0], values[1], values[2], field.coefficients(), field.shape());
  double off = 0, clamped = 0, all = 0, mass = 0, below = 0;
  Eigen::Index at = 0;
  for (const double u : rule.weight)
    for (const double v : rule.weight)
      for (const double w : rule.weight) {
        const double weight = u * v * w, e = exact[at], o = ours[at++];
        off += weight * (o - e) * (o - e);
        clamped += weight * (std::max(0.0, o) - e) * (std::max(0.0, o) - e);
        all += weight * e * e;
        mass += weight * e;
        if (o < 0) below += weight;
      }
  if (all > 0) {
    result.error = std::sqrt(off / all);
    result.clamped_error = std::sqrt(clamped / all);
  }
  if (mass > 0) result.mass_ratio = field.coefficients()[0] * std::sqrt(8.0) / mass;
  result.negative_share = below / 8;
}

}  // namespace

LegendreProjection project_to_legendre(const Medium& medium, const ProjectionOptions& options) {
  const Box box = options.box ? *options.box : bounding_box(medium);
  if (!(box.size().array() > 0).all() || !box.size().allFinite())
    throw Error("the medium has no end, or is empty: expected one with a box");
  for (const int n : options.shape)
    if (n < 1 || n > LegendreBox::most)
      throw Error(fmt::format("{} coefficients along an axis, expected 1 to {}", n, LegendreBox::most));
  if (options.cells < 1 || options.cells > most_cells)
    throw Error(fmt::format("{} cells along an axis, expected 1 to {}", options.cells, most_cells));
  LegendreProjection result;
  Eigen::VectorXd series = projected(medium, box, options);
  if (options.limiter) result.theta = limited(series, options.shape);
  result.values = extremes(series, options.shape);
  result.field = std::make_shared<const LegendreBox>(box, options.shape, std::move(series));
  measure(result, medium, options.cells);
  return result;
}

void write_legendre_csv(const std::string& path, const LegendreBox& field) {
  std::string text = "i,j,k,coefficient\n";
  Eigen::Index at = 0;
  for (int i = 0; i < field.shape()[0]; ++i)
    for (int j = 0; j < field.shape()[1]; ++j)
      for (int k = 0; k < field.shape()[2]; ++k)
        if (const double c = field.coefficients()[at++]; std::abs(c) >= 1e-20)
          text += fmt::format("{},{},{},{}\n", i, j, k, c);
  write_file_atomically(path, text);
}

}  // namespace airlight::scene
