// The airlight of an isotropic light on a lit part of a ray, by the paper's polynomial and by the mapped rule, in
// single or double precision throughout and without memory of its own: what a shader would do.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "methods/shadow_planes/mapped_rule.h"
#include "scene/math/types.h"

namespace airlight::experiments::shadow_planes {

// One light of 1 W/sr, one ray, isotropic medium of albedo 1.
template <class Real>
struct LightOnRay {
  Real extinction;     // [1/m]
  Real T, h;           // [m], as LightFromRay; h > 0
  Real begin, length;  // [m], lit part; length may be infinite
};

// The Taylor polynomial of e^(-a (q(theta) - 1)) about theta = 0, isotropic: `taylor_coefficients` on the stack.
template <class Real>
class FixedPolynomial {
 public:
  static constexpr int most = 12;  // degree

  FixedPolynomial(Real a, int degree) : degree_(degree) {
    c_[0] = 1;
    for (int n = 1; n <= degree; ++n) {
      Real sum = 0;
      for (int j = 1; j <= n; ++j) sum += weights()[j] * c_[n - j];
      c_[n] = -a * sum / Real(n);
    }
  }

  Real integral(Real begin, Real end) const {
    Real sum = 0, low = begin, high = end;
    for (int n = 0; n <= degree_; ++n) {
      sum += c_[n] * (high - low) / Real(n + 1);
      low *= begin;
      high *= end;
    }
    return sum;
  }

 private:
  // j q_j of q = tan(pi/4 + theta/2).
  static const std::array<Real, most + 1>& weights() {
    static const std::array<Real, most + 1> w = [] {
      std::array<double, most + 1> q{1};
      for (int n = 0; n < most; ++n) {
        double sum = n == 0 ? 1 : 0;
        for (int i = 0; i <= n; ++i) sum += q[i] * q[n - i];
        q[n + 1] = 0.5 * sum / (n + 1);
      }
      std::array<Real, most + 1> out;
      for (int n = 0; n <= most; ++n) out[n] = Real(n * q[n]);
      return out;
    }();
    return w;
  }

  int degree_;
  std::array<Real, most + 1> c_;
};

// Airlight of the lit part, integrated over that part alone.
template <class Real>
Real by_polynomial(const LightOnRay<Real>& on, int degree) {
  const Real begin = std::atan2(on.begin - on.T, on.h);
  const Real end = std::isfinite(on.length) ? std::atan2(on.begin + on.length - on.T, on.h) : Real(0.5 * pi);
  return on.extinction / (Real(4 * pi) * on.h) * std::exp(-on.extinction * (on.T + on.h)) *
         FixedPolynomial<Real>(on.extinction * on.h, degree).integral(begin, end);
}

// Airlight as in section 4.2: all light between the eye and the end of the part, minus all light before its beginning.
template <class Real>
Real by_differences(const LightOnRay<Real>& on, int degree) {
  const auto gamma = [&](Real length) {
    return by_polynomial(LightOnRay<Real>{on.extinction, on.T, on.h, 0, length}, degree);
  };
  return gamma(on.begin + on.length) - gamma(on.begin);
}

template <class Real>
Real by_rule(const LightOnRay<Real>& on, const airlight::shadow_planes::MappedRule<Real>& rule) {
  using namespace airlight::shadow_planes;
  const Real near = std::hypot(on.begin - on.T, on.h);
  return on.extinction / Real(4 * pi) * std::exp(-on.extinction * (on.begin + near)) *
         airlight_integral(rule, PhaseForm{}, on.extinction, on.T, on.h, LitPart<Real>{on.begin, on.length},
                           [](Real, Real, Real) { return Real(1); });
}

// m that goes with a number of nodes.
inline int stretch_of(int nodes) { return nodes <= 8 ? 2 : nodes <= 16 ? 3 : 6; }

}  // namespace airlight::experiments::shadow_planes
