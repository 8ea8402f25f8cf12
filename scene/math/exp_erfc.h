// exp(-u) and exp(x^2) erfc(x) without branches and tables, for single doubles and packs of four; the same bits on
// every machine. elementary.h has the exp for single calls and all arguments.
#pragma once
#include "scene/math/pack.h"

namespace airlight {

// exp(-u) is 0 from here on: the exact value is below 4e-308.
inline constexpr double exp_minus_end = 708;

// exp(-u) for u >= 0, also infinite. Relative error 3e-16 below exp_minus_end.
template <class T>
T exp_minus(T u) {
  const T x = smaller(u, splat<T>(exp_minus_end));
  // u = n ln 2 - r with |r| <= ln(2)/2: n by adding 1.5 * 2^52, which rounds and leaves n in the low bits.
  const T shifted = madd(x, 1.4426950408889634074, splat<T>(0x1.8p52));
  const T n = shifted - 0x1.8p52;
  const T r = madd(n, 2.319046813846299616e-17, madd(n, 0x1.62e42fefa39efp-1, -x));
  // Taylor, remainder 0.35^14/14! = 4e-18.
  const T r2 = r * r;
  const T r4 = r2 * r2;
  const T p23 = madd(r, 1.0 / 6, 1.0 / 2);
  const T p45 = madd(r, 1.0 / 120, 1.0 / 24);
  const T p67 = madd(r, 1.0 / 5040, 1.0 / 720);
  const T p89 = madd(r, 1.0 / 362880, 1.0 / 40320);
  const T pab = madd(r, 1.0 / 39916800, 1.0 / 3628800);
  const T pcd = madd(r, 1.0 / 6227020800, 1.0 / 479001600);
  const T low = madd(r4, madd(r2, p67, p45), r2 * p23);
  const T high = madd(r4, pcd, madd(r2, pab, p89));
  const T p = (1 + r) + madd(r4 * r4, high, low);
  return pick(u < exp_minus_end, p * power_of_half(shifted), T{});
}

// erfcx(x) = exp(x^2) erfc(x) for 0 <= x <= 1e15. Relative error 1e-15.
//
// (1 + 2x) erfcx(x) is a polynomial in y = (x - 3.75) / (x + 3.75), y in [-1, 1]: the mapping of Shepherd and
// Laframboise, Math. Comp. 36 (1981) 249. Coefficients: Chebyshev interpolation at 60 nodes in 60 digits, cut at degree
// 24 (remainder 1e-16), turned into powers of y; their absolute values sum to 1.8, so that powers lose nothing.
template <class T>
T erfcx_positive(T x) {
  const T y = (x - 3.75) / (x + 3.75);
  const T y2 = y * y;
  const T y4 = y2 * y2;
  const auto cubic = [&](double a, double b, double c, double d) { return madd(y2, madd(y, d, c), madd(y, b, a)); };
  T p = splat<T>(4.25147144479638978e-10);
  p = madd(y4, p,
           cubic(3.86753342422223568e-8, -3.74421008096201864e-9, -5.17399021401130963e-9, 3.1114333809799252e-10));
  p = madd(y4, p,
           cubic(1.75163764884906214e-6, -5.72182306032240875e-8, -2.58668507161558854e-7, 2.32635087088591237e-8));
  p = madd(
      y4, p,
      cubic(0.0000516490988926824034, 0.0000223842391550822298, -0.0000114441462377005234, -9.73559896736774934e-7));
  p = madd(y4, p,
           cubic(-0.00974657955802927553, 0.00175562585289529536, 0.00029371366559134482, -0.000290154080540841711));
  p = madd(y4, p, cubic(-0.108803930141748857, 0.0923043211603774778, -0.0586933985896367741, 0.0283622774189564043));
  p = madd(y4, p, cubic(1.23751263083782758, -0.140240598585546962, 0.00358541548546442937, 0.0822767384901452077));
  return p / (1 + 2 * x);
}

}  // namespace airlight
