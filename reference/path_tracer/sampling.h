// Directions and distances, each drawn by a `sample` with its density beside it.
#pragma once
#include <cmath>

#include "scene/math/elementary.h"
#include "scene/math/types.h"

namespace airlight::path_tracer {

// The direction at an angle of cosine c to unit w, turned by `turns` (in [0, 1)) about it; unit.
inline Vec3 turned(const Vec3& w, double c, double s, double turns) {
  // Two unit vectors across w from its largest component (no cancellation): a lies in a coordinate plane.
  Vec3 a;
  if (std::abs(w[2]) < 0.7) {
    const double l = 1 / std::sqrt(w[0] * w[0] + w[1] * w[1]);
    a = Vec3(w[1] * l, -w[0] * l, 0);
  } else {
    const double l = 1 / std::sqrt(w[1] * w[1] + w[2] * w[2]);
    a = Vec3(0, w[2] * l, -w[1] * l);
  }
  const Vec3 b(w[1] * a[2] - w[2] * a[1], w[2] * a[0] - w[0] * a[2], w[0] * a[1] - w[1] * a[0]);
  const elementary::SinCos turn = elementary::sincos_turns(turns);
  const Vec3 d = c * w + (s * turn.cos) * a + (s * turn.sin) * b;
  return d * (1.5 - 0.5 * d.squaredNorm());  // one Newton step keeps it unit over a million turns
}
inline Vec3 turned(const Vec3& w, double c, double turns) {
  return turned(w, c, std::sqrt(std::max(0.0, (1 - c) * (1 + c))), turns);
}

// e^x - 1 and ln(1 + x) with their relative accuracy near 0 (Kahan's forms).
inline double expm1(double x) {
  const double e = elementary::exp(x), difference = e - 1;
  if (difference == 0) return x;
  return e < 0.25 ? difference : difference * x / elementary::log(e);
}
inline double log1p(double x) {
  const double sum = 1 + x;
  return sum == 1 ? x : elementary::log(sum) * x / (sum - 1);
}

// An exponential variate of mean 1, given that it is below -ln(1 - probability), however small that is; for the uniform u.
inline double truncated_exponential(double u, double probability) {
  return probability < 0.25 ? -log1p(-u * probability) : -elementary::log(1 - u * probability);
}

// Distances along a ray so that the angles seen from a light are uniform (equiangular sampling: Kulla and Fajardo
// 2012). The light lies at ray parameter D, h beside the ray. h is from the perpendicular, not from a difference of
// squares, and the density and the 1/d^2 of the light use the same h and D, so that their product stays smooth.
struct Equiangular {
  double D, h;        // [m]
  double begin, end;  // [m], end may be infinite
  double psi;         // angle of `begin` seen from the foot point, of (begin - D, h)
  double span = 0;    // angle between begin and end as the light sees them, in [0, pi]

  Equiangular(const Ray& ray, const Point3& light, Interval t) : begin(t.lo), end(t.hi) {
    const Vec3 offset = light - ray.origin;
    D = offset.dot(ray.direction);
    h = (offset - D * ray.direction).norm();
    const double a = begin - D, b = end - D;
    psi = elementary::atan2(h, a);
    span = end == infinity ? psi : elementary::atan2(h * (end - begin), h * h + a * b);
  }
  bool usable() const { return h > 0 && span > 0; }
  double squared_distance(double t) const { return h * h + (t - D) * (t - D); }
  double sample(double u) const {
    const elementary::SinCos angle = elementary::sincos_turns((psi - u * span) / (2 * pi));
    const double t = D + h * angle.cos / angle.sin;
    return t < begin ? begin : t < end ? t : end < infinity ? end : begin;
  }
  // Density over t [1/m].
  double pdf(double t) const { return h / (span * squared_distance(t)); }
};

}  // namespace airlight::path_tracer
