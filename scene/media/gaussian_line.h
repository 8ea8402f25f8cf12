// One Gaussian seen along a ray: its integral in closed form.
//
// Along the ray a Gaussian is amplitude * exp(-exponent - (t - middle)^2 / width^2). Zhou et al. 2007, Eq. 31,
// rewritten so that nothing cancels, and without branches so that a loop over Gaussians becomes SIMD code.
#pragma once
#include <algorithm>
#include <cmath>

#include "scene/math/exp_erfc.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::scene {

struct GaussianLine {
  double middle;    // [m] ray parameter nearest to the centre
  double exponent;  // [-] squared distance of the line from the centre, in widths
  double width;     // [m]
  double amplitude;
};

// Coordinates apart, so that a loop can hold several Gaussians in one register. The foot of the perpendicular by a
// cross product: |q|^2 - m^2 would cancel far away.
inline GaussianLine gaussian_line(double x, double y, double z, double width, double amplitude, const Ray& ray) {
  const Vec3 &o = ray.origin, &d = ray.direction;
  const double qx = x - o[0], qy = y - o[1], qz = z - o[2];
  const double px = d[1] * qz - d[2] * qy, py = d[2] * qx - d[0] * qz, pz = d[0] * qy - d[1] * qx;
  return {qx * d[0] + qy * d[1] + qz * d[2], (px * px + py * py + pz * pz) / (width * width), width, amplitude};
}
inline GaussianLine gaussian_line(const Gaussian& g, const Ray& ray) {
  return gaussian_line(g.center[0], g.center[1], g.center[2], g.width, g.amplitude, ray);
}

// The part of t within `cutoff` widths of the centre.
inline Interval within_cutoff(const GaussianLine& g, double cutoff, Interval t) {
  const double reach = g.width * std::sqrt(std::max(0.0, cutoff * cutoff - g.exponent));
  return intersect(t, {g.middle - reach, g.middle + reach});
}

// A range shorter than this, (t.hi - t.lo) (1 + |t.lo - middle|) in widths, takes the quadrature: error functions would
// cancel.
inline bool is_short(const GaussianLine& g, Interval t) {
  return (t.hi - t.lo) * (g.width + std::abs(t.lo - g.middle)) < 0.5 * g.width * g.width;
}

// Integral over a short range by eight-point Gauss-Legendre: exact to rounding.
inline double short_integral(const GaussianLine& g, Interval t) {
  constexpr double node[4] = {0.01985507175123188416, 0.1016667612931866302, 0.2372337950418355071,
                              0.4082826787521750975};
  constexpr double weight[4] = {0.05061426814518812958, 0.1111905172266872353, 0.1568533229389436437,
                                0.1813418916891809915};
  const double begin = (t.lo - g.middle) / g.width, length = (t.hi - t.lo) / g.width;
  const auto pair = [&](int k) {
    const double left = begin + node[k] * length, right = begin + (1 - node[k]) * length;
    return weight[k] * (exp_minus(g.exponent + left * left) + exp_minus(g.exponent + right * right));
  };
  return g.amplitude * (t.hi - t.lo) * ((pair(0) + pair(1)) + (pair(2) + pair(3)));
}

// Integral over any other range, also infinite. exp(-x^2) erfcx(x) is what lies beyond x on one side: where both ends
// lie on one side of the middle their difference keeps its digits, where plain error functions have none left.
inline double long_integral(const GaussianLine& g, Interval t) {
  constexpr double half_sqrt_pi = 0.88622692545275801365;
  // Beyond 40 widths nothing is left, and infinity stays out of the polynomials.
  const double t1 = std::clamp((t.lo - g.middle) / g.width, -40.0, 40.0);
  const double t2 = std::clamp((t.hi - g.middle) / g.width, -40.0, 40.0);
  const double beyond1 = exp_minus(g.exponent + t1 * t1) * erfcx_positive(std::abs(t1));
  const double beyond2 = exp_minus(g.exponent + t2 * t2) * erfcx_positive(std::abs(t2));
  const double sum = t1 * t2 <= 0 ? 2 * exp_minus(g.exponent) - (beyond1 + beyond2) : std::abs(beyond1 - beyond2);
  return half_sqrt_pi * g.amplitude * g.width * sum;
}

inline double integral(const GaussianLine& g, Interval t) {
  if (t.empty()) return 0;
  return is_short(g, t) ? short_integral(g, t) : long_integral(g, t);
}

// Integral of max(0, f) over t for a sum with negative amplitudes [m]: the signs of f are isolated by bounds, pieces
// where f > 0 are integrated in closed form, and what is left by polynomials of degree 9. Absolute error 1e-13 of the
// integral of the sum of |terms|.
double clamped_line_integral(const GaussianSum&, const Ray&, Interval t);

}  // namespace airlight::scene
