// Gaussians seen along a ray: their integrals in closed form, for one (T = double) or four at a time (T = Pack).
//
// Along the ray a Gaussian is amplitude * exp(-exponent - (t - middle)^2 / width^2). Zhou et al. 2007, Eq. 31,
// rewritten so that nothing cancels and nothing branches.
#pragma once
#include "scene/math/exp_erfc.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::scene {

// Coordinate by coordinate.
template <class T>
struct Gaussians {
  T x, y, z, width, amplitude;
};

inline Gaussians<double> load(const Gaussian& g) {
  return {g.center[0], g.center[1], g.center[2], g.width, g.amplitude};
}

// Four neighbours, by a transposition in registers: copied number by number they would stall the wide loads that
// follow.
inline Gaussians<Pack> load_four(const Gaussian* g) {
  static_assert(sizeof(Gaussian) == 5 * sizeof(double) && offsetof(Gaussian, width) == 3 * sizeof(double));
  const __m256d a = _mm256_loadu_pd(g[0].center.data()), b = _mm256_loadu_pd(g[1].center.data());
  const __m256d c = _mm256_loadu_pd(g[2].center.data()), d = _mm256_loadu_pd(g[3].center.data());
  const __m256d ab_even = _mm256_unpacklo_pd(a, b), ab_odd = _mm256_unpackhi_pd(a, b);
  const __m256d cd_even = _mm256_unpacklo_pd(c, d), cd_odd = _mm256_unpackhi_pd(c, d);
  return {_mm256_permute2f128_pd(ab_even, cd_even, 0x20), _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20),
          _mm256_permute2f128_pd(ab_even, cd_even, 0x31), _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31),
          Pack{g[0].amplitude, g[1].amplitude, g[2].amplitude, g[3].amplitude}};
}

template <class T>
struct Range {
  T lo, hi;
};

template <class T>
struct GaussianLines {
  T middle;    // [m] ray parameter nearest to the centre
  T exponent;  // [-] squared distance of the line from the centre, in widths
  T width;     // [m]
  T amplitude;
};

// The foot of the perpendicular by a cross product: |q|^2 - m^2 would cancel far away.
template <class T>
GaussianLines<T> along(const Gaussians<T>& g, const Ray& ray) {
  const Vec3 &o = ray.origin, &d = ray.direction;
  const T qx = g.x - o[0], qy = g.y - o[1], qz = g.z - o[2];
  const T px = d[1] * qz - d[2] * qy, py = d[2] * qx - d[0] * qz, pz = d[0] * qy - d[1] * qx;
  return {qx * d[0] + qy * d[1] + qz * d[2], (px * px + py * py + pz * pz) / (g.width * g.width), g.width, g.amplitude};
}

// The part of t within `cutoff` widths of the centre; lo = hi if there is none.
template <class T>
Range<T> within_cutoff(const GaussianLines<T>& g, double cutoff, Range<T> t) {
  const T reach = g.width * root(larger(cutoff * cutoff - g.exponent, T{}));
  const T lo = larger(t.lo, g.middle - reach), hi = smaller(t.hi, g.middle + reach);
  return {lo, larger(lo, hi)};
}

// Integral over a range that is not empty and shorter than this: error functions would cancel.
template <class T>
auto is_short(const GaussianLines<T>& g, Range<T> t) {
  return (t.hi - t.lo) * (g.width + absolute(t.lo - g.middle)) < 0.5 * g.width * g.width;
}

// By eight-point Gauss-Legendre: exact to rounding over a short range.
template <class T>
T short_integral(const GaussianLines<T>& g, Range<T> t) {
  constexpr double node[4] = {0.01985507175123188416, 0.1016667612931866302, 0.2372337950418355071,
                              0.4082826787521750975};
  constexpr double weight[4] = {0.05061426814518812958, 0.1111905172266872353, 0.1568533229389436437,
                                0.1813418916891809915};
  const T begin = (t.lo - g.middle) / g.width, length = (t.hi - t.lo) / g.width;
  T sum{};
  for (int k = 0; k < 4; ++k) {
    const T left = begin + node[k] * length, right = begin + (1 - node[k]) * length;
    sum += weight[k] * (exp_minus(g.exponent + left * left) + exp_minus(g.exponent + right * right));
  }
  return g.amplitude * (t.hi - t.lo) * sum;
}

// Over any other range, also infinite. exp(-x^2) erfcx(x) is what lies beyond x on one side: where both ends lie on one
// side of the middle their difference keeps its digits, where plain error functions have none left.
template <class T>
T long_integral(const GaussianLines<T>& g, Range<T> t) {
  constexpr double half_sqrt_pi = 0.88622692545275801365;
  // Beyond 40 widths nothing is left, and infinity stays out of the polynomials.
  const T far = splat<T>(40);
  const T t1 = smaller(larger((t.lo - g.middle) / g.width, -far), far);
  const T t2 = smaller(larger((t.hi - g.middle) / g.width, -far), far);
  const T beyond1 = exp_minus(g.exponent + t1 * t1) * erfcx_positive(absolute(t1));
  const T beyond2 = exp_minus(g.exponent + t2 * t2) * erfcx_positive(absolute(t2));
  const T sum = pick(t1 * t2 <= 0, 2 * exp_minus(g.exponent) - (beyond1 + beyond2), absolute(beyond1 - beyond2));
  return half_sqrt_pi * g.amplitude * g.width * sum;
}

template <class T>
T integral(const GaussianLines<T>& g, Range<T> t) {
  const auto brief = is_short(g, t) & (t.lo < t.hi);
  T value = long_integral(g, t);
  if (any(brief)) value = pick(brief, short_integral(g, t), value);
  return pick(t.lo < t.hi, value, T{});
}

// Integral of max(0, f) over t for a sum with negative amplitudes [m]: the signs of f are isolated by bounds, pieces
// where f > 0 are integrated in closed form, and what is left by polynomials of degree 9. Absolute error 1e-13 of the
// integral of the sum of |terms|.
double clamped_line_integral(const GaussianSum&, const Ray&, Interval t);

}  // namespace airlight::scene
