#include "scene/math/special_functions.h"

#include <algorithm>
#include <cmath>

#include "scene/math/types.h"

namespace airlight {
namespace {

// (1 + 2x) erfcx(x) for x >= 0 as a polynomial in y = (x - 3.75) / (x + 3.75), y in [-1, 1]: the mapping of Shepherd
// and Laframboise, Math. Comp. 36 (1981) 249. Coefficients: Chebyshev interpolation at 60 nodes in 60 digits, cut at
// degree 24 (remainder 1e-16), turned into powers of y; their absolute values sum to 1.8, so that powers lose nothing.
constexpr double scaled_erfcx[25] = {
    1.23751263083782758,      -0.140240598585546962,    0.00358541548546442937,    0.0822767384901452077,
    -0.108803930141748857,    0.0923043211603774778,    -0.0586933985896367741,    0.0283622774189564043,
    -0.00974657955802927553,  0.00175562585289529536,   0.00029371366559134482,    -0.000290154080540841711,
    0.0000516490988926824034, 0.0000223842391550822298, -0.0000114441462377005234, -9.73559896736774934e-7,
    1.75163764884906214e-6,   -5.72182306032240875e-8,  -2.58668507161558854e-7,   2.32635087088591237e-8,
    3.86753342422223568e-8,   -3.74421008096201864e-9,  -5.17399021401130963e-9,   3.1114333809799252e-10,
    4.25147144479638978e-10};

double erfcx_positive(double x) {
  const double y = (x - 3.75) / (x + 3.75);
  double p = scaled_erfcx[24];
  for (int k = 23; k >= 0; --k) p = p * y + scaled_erfcx[k];
  return p / (1 + 2 * x);
}

}  // namespace

double erfcx(double x) {
  if (x >= 0) return x < 1e17 ? erfcx_positive(x) : 1 / (std::sqrt(pi) * x);
  if (!(x > -26.7)) return std::isnan(x) ? x : infinity;
  // exp(x^2) with the rounding error of the square put back: x^2 reaches 700, where an ulp is 1e-13.
  const double square = x * x;
  const double rest = std::fma(x, x, -square);
  return 2 * std::exp(square) * (1 + rest) - erfcx_positive(-x);
}

double mean_exp_minus(double x) { return x == 0 ? 1 : -std::expm1(-x) / x; }

double mean_transmittance(double a, double b) {
  // From the thinner end, so that the factor in front is the larger exponential.
  const double least = std::min(a, b);
  return least == infinity ? 0 : std::exp(-least) * mean_exp_minus(std::abs(b - a));
}

}  // namespace airlight
