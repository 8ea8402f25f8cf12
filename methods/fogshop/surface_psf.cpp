#include "methods/fogshop/surface_psf.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/math/exponential_integral.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/special_functions.h"
#include "scene/math/types.h"

namespace airlight::fogshop {
namespace {

// Im e^z E1(z); its limit for T = 0 is the angle of 1 / (1 - e^(i gamma)).
double scattered(double gamma, double T) {
  if (!(T > 0)) return 0.5 * (pi - gamma);
  const double half = std::sin(0.5 * gamma);
  return scene::scaled_exponential_integral({2 * T * half * half, -T * std::sin(gamma)}).imag();
}

}  // namespace

double npsf(double gamma, double T) { return scattered(gamma, T) / (2 * pi * std::sin(gamma)); }

double npsf_coefficient(int l, double T) {
  // The integrand behaves as gamma ln(T gamma) near 0: gamma = pi x^6 leaves x^11 ln x, and spreads what a thick medium
  // crowds into gamma < 1/T.
  static const scene::GaussLegendre rule = scene::gauss_legendre(96);
  double sum = 0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double x = 0.5 * (1 + rule.node[i]), x2 = x * x, gamma = pi * x2 * x2 * x2;
    sum +=
        0.5 * rule.weight[i] * scattered(gamma, T) * std::legendre(unsigned(l), std::cos(gamma)) * 6 * pi * x2 * x2 * x;
  }
  return std::sqrt((2 * l + 1) / (4 * pi)) * sum;
}

double average_depth(double u) {
  const double half_root_pi = 0.88622692545275801;  // sqrt(pi) / 2
  // D(u)/u = 1 - 2/3 u^2 + ...
  return std::abs(u) < 1e-9 ? half_root_pi : half_root_pi * dawson(u) / u;
}

}  // namespace airlight::fogshop
