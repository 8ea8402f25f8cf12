#include "scene/media/gaussian_sum.h"

#include <algorithm>
#include <cmath>

#include "scene/media/gaussian_line.h"

namespace airlight::scene {
namespace {

// Beyond this many widths a Gaussian is below 1e-17 of its amplitude.
constexpr double negligible_widths = 6.257;

double squared_distance(const Point3& x, const Point3& center) {
  const double dx = x[0] - center[0];
  const double dy = x[1] - center[1];
  const double dz = x[2] - center[2];
  return dx * dx + dy * dy + dz * dz;
}

Point3 nearest_point(const Box& box, const Point3& x) { return x.cwiseMax(box.lo).cwiseMin(box.hi); }

Point3 farthest_point(const Box& box, const Point3& x) {
  Point3 far;
  for (int i = 0; i < 3; ++i) far[i] = std::abs(box.lo[i] - x[i]) > std::abs(box.hi[i] - x[i]) ? box.lo[i] : box.hi[i];
  return far;
}

}  // namespace

double density(const GaussianSum& sum, const Point3& x) {
  const double cutoff2 = sum.cutoff * sum.cutoff;
  double value = sum.constant;
  for (const Gaussian& g : sum.gaussians) {
    const double exponent = squared_distance(x, g.center) / (g.width * g.width);
    if (exponent < cutoff2) value += g.amplitude * std::exp(-exponent);
  }
  return std::max(0.0, value);
}

Interval density_bounds(const GaussianSum& sum, const Box& box) {
  const double cutoff2 = sum.cutoff * sum.cutoff;
  double lo = sum.constant;
  double hi = sum.constant;
  double magnitude = sum.constant;
  for (const Gaussian& g : sum.gaussians) {
    // Every operation of `density` up to the exponent is monotone in the distance along each axis, also when rounded:
    // no point of the box has an exponent outside [near, far].
    const double near = squared_distance(nearest_point(box, g.center), g.center) / (g.width * g.width);
    if (!(near < cutoff2)) continue;
    const double far = squared_distance(farthest_point(box, g.center), g.center) / (g.width * g.width);
    const double greatest = g.amplitude * std::exp(-near);
    const double least = far < cutoff2 ? g.amplitude * std::exp(-far) : 0;
    hi += std::max(greatest, least);
    lo += std::min(greatest, least);
    magnitude += std::abs(greatest);
  }
  // Outwards by the rounding of the exponentials and of the two sums, that of `density` and this one.
  const double slack = magnitude * 4.5e-16 * (sum.gaussians.size() + 4);
  return {std::max(0.0, lo - slack), std::max(0.0, hi + slack)};
}

double line_integral(const Gaussian& g, const Ray& ray, double d) { return gaussian_line(g, ray).integral({0, d}); }

double density_integral(const GaussianSum& sum, const Ray& ray, Interval t) {
  if (t.empty()) return 0;
  double integral = sum.constant > 0 ? sum.constant * (t.hi - t.lo) : 0;
  bool negative = false;
  for (const Gaussian& g : sum.gaussians) {
    const GaussianLine line = gaussian_line(g, ray);
    negative |= g.amplitude < 0;
    integral += line.integral(line.clip(sum.cutoff, t));
  }
  return negative ? clamped_line_integral(sum, ray, t) : integral;
}

Box support(const GaussianSum& sum) {
  Box box;
  const double widths = std::min(negligible_widths, sum.cutoff);
  for (const Gaussian& g : sum.gaussians) {
    if (g.amplitude == 0) continue;
    const double radius = widths * g.width * (1 + 1e-15);
    const Vec3 reach = Vec3::Constant(radius) + 1e-15 * g.center.cwiseAbs();
    box = unite(box, {g.center - reach, g.center + reach});
  }
  return box;
}

}  // namespace airlight::scene
