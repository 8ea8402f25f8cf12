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

// Where the light is many widths away 1/d^2 is smooth over the Gaussian, and the closed forms below cancel.
VoigtMoments far_moments(double X, double Y) {
  double sum[4] = {};
  for (int k = 0; k < 8; ++k) {
    const double u = k % 2 ? hermite_node[k / 2] : -hermite_node[k / 2];
    double term = hermite_weight[k / 2] / ((X - u) * (X - u) + Y * Y);
    for (double& s : sum) {
      s += term;
      term *= u;
    }
  }
  const double m1 = sum[1] / sum[0], m2 = sum[2] / sum[0], m3 = sum[3] / sum[0];
  return {sum[0] * std::sqrt(pi), m1, m2 - m1 * m1, m3 - 3 * m1 * m2 + 2 * m1 * m1 * m1};
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
  if (a * m < cut || a * (length - m) < cut) {
    static const scene::GaussLegendre rule = scene::gauss_legendre(16);
    const double lo = std::max(0.0, m - reach / a), hi = std::min(length, m + reach / a);
    if (!(lo < hi)) return;
    const double ends[] = {lo, 0.5 * (lo + hi), hi};
    for (int part = 0; part < 2; ++part) {
      const double xa = ends[part] - along, xb = ends[part + 1] - along;
      const double span = std::atan2(h * (xb - xa), h * h + xa * xb);
      for (int k = 0; k < 16; ++k) {
        const double angle = 0.5 * (1 + rule.node[k]) * span, tau = std::tan(angle) / h;
        const double t = std::clamp(along + (xa + h * h * tau) / (1 - xa * tau), lo, hi), u = a * (t - m);
        nodes.push_back({t, 0.5 * rule.weight[k] * span / h * peak * std::exp(-u * u), i});
      }
    }
    return;
  }
  const VoigtMoments v = voigt_moments(a * (along - m), a * h);
  const double total = peak * a * v.integral;  // du = a dt, and 1/d^2 is a^2 over the density's
  const double deviation = std::sqrt(std::max(v.variance, 1e-12)), skew = 0.5 * v.third / std::pow(deviation, 3);
  const double root = std::sqrt(1 + skew * skew);
  for (const int sign : {-1, 1})
    nodes.push_back({m + (v.mean + deviation * (skew + sign * root)) / a, total * 0.5 * (1 - sign * skew / root), i});
}

}  // namespace airlight::fogshop
