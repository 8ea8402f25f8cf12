#include "scene/media/gaussian_sum.h"

#include <algorithm>
#include <cmath>

#include "scene/media/gaussian_block.h"

namespace airlight::scene {
namespace {

// Beyond this many widths a Gaussian is below 1e-17 of its amplitude.
constexpr double negligible_widths = 6.257;

double squared_distance(double dx, double dy, double dz) { return dx * dx + dy * dy + dz * dz; }
double squared_distance(const Point3& a, const Point3& b) {
  return squared_distance(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
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
  const auto value = [&](double center_x, double center_y, double center_z, double width, double amplitude) {
    const double exponent = squared_distance(x[0] - center_x, x[1] - center_y, x[2] - center_z) / (width * width);
    const double inside = amplitude * exp_minus(exponent);
    return exponent < cutoff2 ? inside : 0.0;
  };
  const std::size_t n = sum.gaussians.size(), whole = n - n % lanes;
  Lanes values{};
  for (std::size_t first = 0; first < whole; first += lanes) {
    const GaussianBlock b(&sum.gaussians[first]);
    for (int k = 0; k < lanes; ++k) values[k] += value(b.x[k], b.y[k], b.z[k], b.width[k], b.amplitude[k]);
  }
  double f = sum.constant + total(values);
  for (std::size_t i = whole; i < n; ++i) {
    const Gaussian& g = sum.gaussians[i];
    f += value(g.center[0], g.center[1], g.center[2], g.width, g.amplitude);
  }
  return std::max(0.0, f);
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
    const double greatest = g.amplitude * exp_minus(near);
    const double least = far < cutoff2 ? g.amplitude * exp_minus(far) : 0;
    hi += std::max(greatest, least);
    lo += std::min(greatest, least);
    magnitude += std::abs(greatest);
  }
  // Outwards by the rounding of the exponentials and of the two sums, that of `density` and this one.
  const double slack = magnitude * 4.5e-16 * (sum.gaussians.size() + 4);
  return {std::max(0.0, lo - slack), std::max(0.0, hi + slack)};
}

double line_integral(const Gaussian& g, const Ray& ray, double d) { return integral(gaussian_line(g, ray), {0, d}); }

double density_integral(const GaussianSum& sum, const Ray& ray, Interval t) {
  if (t.empty()) return 0;
  Lanes sums{};
  double least_amplitude = 0;
  for_each_block(sum.gaussians, [&](const GaussianBlock& b) {
    Lanes lo, hi, values, is_shorts;
    lo.fill(t.lo);
    hi.fill(t.hi);
    if (sum.cutoff < infinity)
      for (int k = 0; k < lanes; ++k) {
        const Interval part = within_cutoff(b.line(k, ray), sum.cutoff, t);
        lo[k] = part.lo;
        hi[k] = std::max(part.lo, part.hi);
      }
    for (int k = 0; k < lanes; ++k) {
      const GaussianLine line = b.line(k, ray);
      values[k] = long_integral(line, {lo[k], hi[k]});
      // What a cutoff leaves empty comes out as 0 above.
      const double length = is_short(line, {lo[k], hi[k]}) ? hi[k] - lo[k] : 0;
      is_shorts[k] = length > 0 ? 1 : 0;
    }
    if (total(is_shorts) > 0)
      for (int k = 0; k < lanes; ++k) {
        const double value = short_integral(b.line(k, ray), {lo[k], hi[k]});
        values[k] = is_shorts[k] > 0 ? value : values[k];
      }
    for (int k = 0; k < lanes; ++k) {
      sums[k] += values[k];
      least_amplitude = std::min(least_amplitude, b.amplitude[k]);
    }
  });
  if (least_amplitude < 0) return clamped_line_integral(sum, ray, t);
  return total(sums) + (sum.constant > 0 ? sum.constant * (t.hi - t.lo) : 0);
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
