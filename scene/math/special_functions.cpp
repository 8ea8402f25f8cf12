#include "scene/math/special_functions.h"

#include <algorithm>
#include <cmath>

#include "scene/math/elementary.h"
#include "scene/math/exp_erfc.h"
#include "scene/math/types.h"

namespace airlight {
double erfcx(double x) {
  if (x >= 0) return x < 1e17 ? erfcx_positive(x) : 1 / (std::sqrt(pi) * x);
  if (!(x > -26.7)) return std::isnan(x) ? x : infinity;
  // exp(x^2) with the rounding error of the square put back: x^2 reaches 700, where an ulp is 1e-13.
  const double square = x * x;
  const double rest = std::fma(x, x, -square);
  return 2 * elementary::exp(square) * (1 + rest) - erfcx_positive(-x);
}

double mean_exp_minus(double x) { return x == 0 ? 1 : -std::expm1(-x) / x; }

double mean_transmittance(double a, double b) {
  // From the thinner end, so that the factor in front is the larger exponential.
  const double least = std::min(a, b);
  return least == infinity ? 0 : elementary::exp(-least) * mean_exp_minus(std::abs(b - a));
}

}  // namespace airlight
