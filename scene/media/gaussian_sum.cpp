#include "scene/media/gaussian_sum.h"

#include <algorithm>
#include <cmath>

#include "scene/media/gaussian_line.h"

namespace airlight::scene {
namespace {

// Beyond this many widths a Gaussian is below 1e-17 of its amplitude.
constexpr double negligible_widths = 6.257;

// The square of the distance in widths at which a Gaussian ends: the cutoff, or where it is 0 in double precision.
double reach2(const GaussianSum& sum) { return std::min(sum.cutoff * sum.cutoff, exp_minus_end); }

// Calls f(Gaussians<Pack>) for all; what is missing in the last four are Gaussians of amplitude 0.
template <class F>
void for_each_pack(const std::vector<Gaussian>& gaussians, F&& f) {
  const std::size_t n = gaussians.size(), rest = n % pack_size, whole = n - rest;
  for (std::size_t i = 0; i < whole; i += pack_size) f(load_four(&gaussians[i]));
  if (rest == 0) return;
  static const Gaussian none{Point3::Zero(), 1, 0};
  const Gaussian &a = gaussians[whole], &b = rest > 1 ? gaussians[whole + 1] : none;
  const Gaussian& c = rest > 2 ? gaussians[whole + 2] : none;
  f(Gaussians<Pack>{{a.center[0], b.center[0], c.center[0], 0},
                    {a.center[1], b.center[1], c.center[1], 0},
                    {a.center[2], b.center[2], c.center[2], 0},
                    {a.width, b.width, c.width, 1},
                    {a.amplitude, b.amplitude, c.amplitude, 0}});
}

template <class T>
T squared_distance(T dx, T dy, T dz) {
  return dx * dx + dy * dy + dz * dz;
}
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
  const double limit = reach2(sum);
  Pack values{};
  for_each_pack(sum.gaussians, [&](const Gaussians<Pack>& g) {
    const Pack exponent = squared_distance<Pack>(x[0] - g.x, x[1] - g.y, x[2] - g.z) / (g.width * g.width);
    const PackMask near = exponent < limit;
    if (any(near)) values += pick(near, g.amplitude * exp_minus(exponent), Pack{});
  });
  return std::max(0.0, sum.constant + total(values));
}

Interval density_bounds(const GaussianSum& sum, const Box& box) {
  const double limit = reach2(sum);
  double lo = sum.constant;
  double hi = sum.constant;
  double magnitude = sum.constant;
  for (const Gaussian& g : sum.gaussians) {
    // Every operation of `density` up to the exponent is monotone in the distance along each axis, also when rounded:
    // no point of the box has an exponent outside [near, far].
    const double near = squared_distance(nearest_point(box, g.center), g.center) / (g.width * g.width);
    if (!(near < limit)) continue;
    const double far = squared_distance(farthest_point(box, g.center), g.center) / (g.width * g.width);
    const double greatest = g.amplitude * exp_minus(near);
    const double least = far < limit ? g.amplitude * exp_minus(far) : 0;
    hi += std::max(greatest, least);
    lo += std::min(greatest, least);
    magnitude += std::abs(greatest);
  }
  // Outwards by the rounding of the exponentials and of the two sums, that of `density` and this one.
  const double slack = magnitude * 4.5e-16 * (sum.gaussians.size() + 4);
  return {std::max(0.0, lo - slack), std::max(0.0, hi + slack)};
}

double line_integral(const Gaussian& g, const Ray& ray, double d) { return integral(along(load(g), ray), {0.0, d}); }

double density_integral(const GaussianSum& sum, const Ray& ray, Interval t) {
  if (t.empty()) return 0;
  const double limit = reach2(sum);
  const bool cut = sum.cutoff < infinity;
  Pack values{};
  bool negative = false;
  for_each_pack(sum.gaussians, [&](const Gaussians<Pack>& g) {
    negative |= any(g.amplitude < 0);
    const GaussianLines<Pack> line = along(g, ray);
    if (!any(line.exponent < limit)) return;
    Range<Pack> range{splat<Pack>(t.lo), splat<Pack>(t.hi)};
    if (cut) range = within_cutoff(line, sum.cutoff, range);
    values += integral(line, range);
  });
  if (negative) return clamped_line_integral(sum, ray, t);
  return total(values) + (sum.constant > 0 ? sum.constant * (t.hi - t.lo) : 0);
}

Interval extent(const GaussianSum& sum, const Ray& ray, Interval t) {
  if (sum.constant > 0) return t;
  const double widths = std::min(negligible_widths, sum.cutoff);
  Pack lo = splat<Pack>(infinity), hi = splat<Pack>(-infinity);
  for_each_pack(sum.gaussians, [&](const Gaussians<Pack>& g) {
    const GaussianLines<Pack> line = along(g, ray);
    if (!any(line.exponent < widths * widths)) return;
    const Range<Pack> part = within_cutoff(line, widths, {splat<Pack>(t.lo), splat<Pack>(t.hi)});
    const PackMask counts = (part.lo < part.hi) & (g.amplitude != 0);
    lo = pick(counts, smaller(part.lo, lo), lo);
    hi = pick(counts, larger(part.hi, hi), hi);
  });
  Interval hull;
  for (int k = 0; k < pack_size; ++k) hull = {std::min(hull.lo, lo[k]), std::max(hull.hi, hi[k])};
  return hull;
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
