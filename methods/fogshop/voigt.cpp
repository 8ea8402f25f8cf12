#include "methods/fogshop/voigt.h"

#include <algorithm>
#include <cmath>

#include "scene/math/faddeeva.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::fogshop {
namespace {

constexpr double least_h = 1e-9;        // [m], as in slices
constexpr double cut = 3, reach = 4.5;  // [widths]

// Gauss-Hermite, 8 points: half of them, and their weights over sqrt(pi).
constexpr double hermite_node[] = {0.38118699020732211, 1.1571937124467802, 1.9816567566958429, 2.9306374202572440};
constexpr double hermite_weight[] = {0.37301225767907736, 0.11723990766175900, 0.0096352201207882635,
                                     0.00011261453837536782};

// From the powers 0 to 3 of u over the density, not normalised.
VoigtMoments central(const double sum[4]) {
  const double m1 = sum[1] / sum[0], m2 = sum[2] / sum[0], m3 = sum[3] / sum[0];
  return {sum[0], m1, m2 - m1 * m1, m3 - 3 * m1 * m2 + 2 * m1 * m1 * m1};
}

void add_powers(double weight, double u, double sum[4]) {
  for (int k = 0; k < 4; ++k, weight *= u) sum[k] += weight;
}

// Where the light is many widths away 1/d^2 is smooth over the Gaussian, and the closed forms below cancel.
VoigtMoments far_moments(double X, double Y) {
  double sum[4] = {};
  for (int k = 0; k < 8; ++k) {
    const double u = k % 2 ? hermite_node[k / 2] : -hermite_node[k / 2];
    add_powers(std::sqrt(pi) * hermite_weight[k / 2] / ((X - u) * (X - u) + Y * Y), u, sum);
  }
  return central(sum);
}

// Of the part of the Gaussian between two values of u: 16 points at even angles from the light in each half.
VoigtMoments part_moments(double X, double Y, double lo, double hi) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(16);
  const double ends[] = {lo, 0.5 * (lo + hi), hi};
  double sum[4] = {};
  for (int part = 0; part < 2; ++part) {
    const double xa = ends[part] - X, xb = ends[part + 1] - X, span = std::atan2(Y * (xb - xa), Y * Y + xa * xb);
    for (int k = 0; k < 16; ++k) {
      const double tau = std::tan(0.5 * (1 + rule.node[k]) * span) / Y;
      const double u = std::clamp(X + (xa + Y * Y * tau) / (1 - xa * tau), ends[part], ends[part + 1]);
      add_powers(0.5 * rule.weight[k] * span / Y * std::exp(-u * u), u, sum);
    }
  }
  return central(sum);
}

}  // namespace

VoigtMoments voigt_moments(double X, double Y) {
  if (X * X + Y * Y > 100) return far_moments(X, Y);
  const std::complex<double> w = scene::faddeeva({X, Y});
  const double re = w.real(), im = w.imag();
  // Of v = X - u.
  const double v1 = Y * im / re, v2 = Y / (std::sqrt(pi) * re) - Y * Y;
  const double v3 = (std::sqrt(pi) * X - pi * Y * Y * im) * Y / (pi * re);
  return {pi / Y * re, X - v1, v2 - v1 * v1, -(v3 - 3 * v1 * v2 + 2 * v1 * v1 * v1)};
}

void append_voigt_nodes(const Crossings& c, int i, double length, double along, double h,
                        std::vector<VoigtNode>& nodes) {
  h = std::max(h, least_h);
  const double a = c.a[i], m = c.middle[i];
  const double peak = c.depth[i] * 2 * a / std::sqrt(pi);  // extinction at the middle [1/m]
  const double X = a * (along - m), Y = a * h;
  VoigtMoments v;
  if (a * m < cut || a * (length - m) < cut) {
    const double lo = std::max(-a * m, -reach), hi = std::min(a * (length - m), reach);
    if (!(lo < hi)) return;
    v = part_moments(X, Y, lo, hi);
    if (!(v.integral > 0)) return;
  } else {
    v = voigt_moments(X, Y);
  }
  const double total = peak * a * v.integral;  // du = a dt, and 1/d^2 is a^2 over the density's
  const double deviation = std::sqrt(std::max(v.variance, 1e-12)), skew = 0.5 * v.third / std::pow(deviation, 3);
  const double root = std::sqrt(1 + skew * skew);
  for (const int sign : {-1, 1})
    nodes.push_back({m + (v.mean + deviation * (skew + sign * root)) / a, total * 0.5 * (1 - sign * skew / root), i});
}

}  // namespace airlight::fogshop
