// Random inputs of the media tests: fixed seeds, the same on every machine.
#pragma once
#include <algorithm>
#include <cmath>
#include <random>

#include "scene/math/types.h"

namespace airlight {

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : engine_(seed) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * (engine_() >> 11) * 0x1p-53; }
  Point3 in(const Box& box) {
    return {uniform(box.lo[0], box.hi[0]), uniform(box.lo[1], box.hi[1]), uniform(box.lo[2], box.hi[2])};
  }
  Vec3 direction() {
    const double z = uniform(-1, 1), phi = uniform(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  // A box inside `within`, of any size down to a point.
  Box box(const Box& within) {
    const Point3 a = in(within);
    const double size = std::pow(10.0, uniform(-6, 0));
    const Point3 b = a + size * (in(within)-a);
    return {a.cwiseMin(b), a.cwiseMax(b)};
  }

 private:
  std::mt19937_64 engine_;
};

// Integral of f over [lo, hi]: a Lobatto rule of five points on a piece, on its two halves and on its three thirds must
// agree to `tolerance` (absolute, shared out among pieces), else the piece is halved. The ends are nodes, so that one
// jump inside a piece cannot hide. It shares nothing with closed forms. At least 32 pieces.
template <class F>
double adaptive_integral(const F& f, double lo, double hi, double tolerance, int depth = 0) {
  const auto rule = [&](double a, double b) {
    const double c = 0.5 * (a + b), h = 0.5 * (b - a), inner = h * std::sqrt(3.0 / 7);
    return h * (32 * f(c) / 45 + 49 * (f(c - inner) + f(c + inner)) / 90 + (f(a) + f(b)) / 10);
  };
  const double middle = 0.5 * (lo + hi), third = (hi - lo) / 3;
  if (depth >= 5) {
    const double whole = rule(lo, hi), halves = rule(lo, middle) + rule(middle, hi);
    const double thirds = rule(lo, lo + third) + rule(lo + third, hi - third) + rule(hi - third, hi);
    const double spread = std::max(std::abs(whole - halves), std::abs(whole - thirds));
    if (depth > 50 || spread <= tolerance) return thirds;
  }
  return adaptive_integral(f, lo, middle, 0.5 * tolerance, depth + 1) +
         adaptive_integral(f, middle, hi, 0.5 * tolerance, depth + 1);
}

}  // namespace airlight
