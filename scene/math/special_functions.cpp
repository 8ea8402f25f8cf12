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

double dawson(double x) {
  const double square = x * x;
  if (std::abs(x) < 6.5) {
    // exp(-x^2) sum x^(2n+1) / (n! (2n+1)): all terms positive.
    double power = 1, sum = 0;
    for (int n = 0; n < 200; ++n) {
      const double term = power / (2 * n + 1);
      sum += term;
      if (n > square && term < 1e-17 * sum) break;
      power *= square / (n + 1);
    }
    return x * elementary::exp(-square) * (1 - std::fma(x, x, -square)) * sum;
  }
  // 1/(2x) sum (2n-1)!! / (2 x^2)^n; its least term is below e^-42 here.
  double term = 1, sum = 0;
  for (int n = 0; n < 40 && term > 1e-18; ++n) {
    sum += term;
    term *= (2 * n + 1) / (2 * square);
  }
  return sum / (2 * x);
}

double mean_exp_minus(double x) { return x == 0 ? 1 : -std::expm1(-x) / x; }

double mean_transmittance(double a, double b) {
  // From the thinner end, so that the factor in front is the larger exponential.
  const double least = std::min(a, b);
  return least == infinity ? 0 : elementary::exp(-least) * mean_exp_minus(std::abs(b - a));
}

}  // namespace airlight
