// exp(-u) and exp(x^2) erfc(x) without branches and tables, so that loops over them become SIMD code; the same bits on
// every machine. elementary.h has the exp for single calls and all arguments.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

namespace airlight {

// exp(-u) for u >= 0, also infinite. Relative error 3e-16; 0 for u > 708, where the exact value is below 1e-307.
inline double exp_minus(double u) {
  const double x = u < 708 ? u : 708;
  // u = n ln 2 - r with |r| <= ln(2)/2: n by adding 1.5 * 2^52, which rounds and leaves n in the low bits.
  constexpr double shift = 0x1.8p52;
  const double shifted = std::fma(x, 1.4426950408889634074, shift);
  const double n = shifted - shift;
  const double r = std::fma(n, 2.319046813846299616e-17, std::fma(n, 0x1.62e42fefa39efp-1, -x));
  // Taylor, remainder 0.35^14/14! = 4e-18.
  const double r2 = r * r;
  const double r4 = r2 * r2;
  const double p01 = 1 + r;
  const double p23 = std::fma(r, 1.0 / 6, 1.0 / 2);
  const double p45 = std::fma(r, 1.0 / 120, 1.0 / 24);
  const double p67 = std::fma(r, 1.0 / 5040, 1.0 / 720);
  const double p89 = std::fma(r, 1.0 / 362880, 1.0 / 40320);
  const double pab = std::fma(r, 1.0 / 39916800, 1.0 / 3628800);
  const double pcd = std::fma(r, 1.0 / 6227020800, 1.0 / 479001600);
  const double low = std::fma(r4, std::fma(r2, p67, p45), r2 * p23);
  const double high = std::fma(r4, pcd, std::fma(r2, pab, p89));
  const double p = p01 + std::fma(r4 * r4, high, low);
  // 2^-n from the bits of n.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(shifted);
  const double scale = std::bit_cast<double>((std::uint64_t(1023) - bits) << 52);
  return u < 708 ? p * scale : 0.0;
}

// erfcx(x) = exp(x^2) erfc(x) for 0 <= x <= 1e15. Relative error 1e-15.
//
// (1 + 2x) erfcx(x) is a polynomial in y = (x - 3.75) / (x + 3.75), y in [-1, 1]: the mapping of Shepherd and
// Laframboise, Math. Comp. 36 (1981) 249. Coefficients: Chebyshev interpolation at 60 nodes in 60 digits, cut at degree
// 24 (remainder 1e-16), turned into powers of y; their absolute values sum to 1.8, so that powers lose nothing.
inline double erfcx_positive(double x) {
  const double y = (x - 3.75) / (x + 3.75);
  const double y2 = y * y;
  const double y4 = y2 * y2;
  const auto cubic = [&](double a, double b, double c, double d) {
    return std::fma(y2, std::fma(y, d, c), std::fma(y, b, a));
  };
  double p = 4.25147144479638978e-10;
  p = std::fma(y4, p,
               cubic(3.86753342422223568e-8, -3.74421008096201864e-9, -5.17399021401130963e-9, 3.1114333809799252e-10));
  p = std::fma(y4, p,
               cubic(1.75163764884906214e-6, -5.72182306032240875e-8, -2.58668507161558854e-7, 2.32635087088591237e-8));
  p = std::fma(
      y4, p,
      cubic(0.0000516490988926824034, 0.0000223842391550822298, -0.0000114441462377005234, -9.73559896736774934e-7));
  p = std::fma(
      y4, p, cubic(-0.00974657955802927553, 0.00175562585289529536, 0.00029371366559134482, -0.000290154080540841711));
  p = std::fma(y4, p,
               cubic(-0.108803930141748857, 0.0923043211603774778, -0.0586933985896367741, 0.0283622774189564043));
  p = std::fma(y4, p, cubic(1.23751263083782758, -0.140240598585546962, 0.00358541548546442937, 0.0822767384901452077));
  return p / (1 + 2 * x);
}

}  // namespace airlight
