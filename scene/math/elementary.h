// Logarithm, exponential, sine, cosine and arc tangent in double precision with a maximal error of about 1 ulp.
//
// The ones of the C library differ between machines in the last bit; a reference that promises the same bits wherever
// it runs cannot use them. These use only IEEE operations and explicit fused multiply-adds, have few branches, and
// their tables are computed by the compiler. Ranges are reduced by table (log, exp, atan) or quadrant (sin, cos); what
// is left is a short Taylor series. tests/scene/math/elementary_test.cpp measures the errors.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "scene/math/types.h"

namespace airlight::elementary {

namespace detail {

// ln x by 2 atanh((x-1)/(x+1)), to long double precision, for x near 1 (tables only).
constexpr long double table_log(long double x) {
  const long double s = (x - 1) / (x + 1);
  long double power = s, sum = 0;
  for (int n = 1; n < 80; n += 2, power *= s * s) sum += power / n;
  return 2 * sum;
}
constexpr long double table_exp(long double x) {
  long double term = 1, sum = 0;
  for (int n = 1; n < 40; ++n) {
    sum += term;
    term *= x / n;
  }
  return sum;
}
// atan x by halving: atan x = 2 atan(x / (1 + sqrt(1 + x^2))); the root by Newton's iteration.
constexpr long double table_atan(long double x) {
  for (int halving = 0; halving < 3; ++halving) {
    long double root = 1;
    for (int i = 0; i < 30; ++i) root = 0.5L * (root + (1 + x * x) / root);
    x /= 1 + root;
  }
  long double power = x, sum = 0;
  int sign = 1;
  for (int n = 1; n < 60; n += 2, power *= x * x, sign = -sign) sum += sign * power / n;
  return 8 * sum;
}

inline constexpr long double ln2 = 0.693147180559945309417232121458176568L;
// Bits of the lower end of the mantissas in log: 1 then lies in the middle of an interval of the table.
inline constexpr std::uint64_t log_begin = 0x3ff0000000000000ULL - (129ULL << 44);

struct LogEntry {
  double inverse;  // about 1/c for an interval's centre c
  double log;      // -ln(inverse)
};

// 128 intervals of the mantissa in [0.748, 1.496). Where an interval holds 1 the entry is exactly (1, 0), so
// that ln x keeps its relative accuracy there.
constexpr std::array<LogEntry, 128> make_log_table() {
  std::array<LogEntry, 128> table{};
  for (int i = 0; i < 128; ++i) {
    const double lo = std::bit_cast<double>(log_begin + (std::uint64_t(i) << 45));
    const double hi = std::bit_cast<double>(log_begin + (std::uint64_t(i + 1) << 45));
    const double inverse = lo <= 1 && hi >= 1 ? 1 : 2 / (lo + hi);
    table[i] = {inverse, double(-table_log(inverse))};
  }
  return table;
}
constexpr std::array<double, 64> make_exp_table() {
  std::array<double, 64> table{};
  for (int i = 0; i < 64; ++i) table[i] = double(table_exp(i * ln2 / 64));
  return table;
}
constexpr std::array<double, 33> make_atan_table() {
  std::array<double, 33> table{};
  for (int i = 0; i <= 32; ++i) table[i] = double(table_atan(i / 32.0L));
  return table;
}

inline constexpr auto log_table = make_log_table();
inline constexpr auto exp_table = make_exp_table();
inline constexpr auto atan_table = make_atan_table();

}  // namespace detail

// ln x for a positive normal x.
inline double log(double x) {
  using namespace detail;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t shifted = bits - log_begin;
  const std::int64_t exponent = std::int64_t(shifted) >> 52;
  const double mantissa = std::bit_cast<double>(bits - (std::uint64_t(exponent) << 52));
  const LogEntry& entry = log_table[(shifted >> 45) & 127];
  const double r = std::fma(mantissa, entry.inverse, -1.0);  // |r| < 2^-7
  constexpr double ln2_hi = 0x1.62e42fefa38p-1;              // 43 bits: times an exponent it is exact
  constexpr double ln2_lo = double(ln2 - ln2_hi);
  const double k = double(exponent);
  const double r2 = r * r;
  const double a = std::fma(r, 1.0 / 3, -0.5);
  const double b = std::fma(r, 1.0 / 5, -0.25);
  const double c = std::fma(r, 1.0 / 7, -1.0 / 6);
  const double d = std::fma(r, 1.0 / 9, -1.0 / 8);
  const double tail = r2 * std::fma(r2, std::fma(r2, std::fma(r2, d, c), b), a);
  const double head = std::fma(k, ln2_hi, entry.log);
  // head + r exactly as sum + error: |head| is 0 or larger than |r|.
  const double sum = head + r;
  const double error = head == 0 ? 0 : r - (sum - head);
  return sum + (error + std::fma(k, ln2_lo, tail));
}

// e^x; 0 below -745.2, infinity above 709.8.
inline double exp(double x) {
  using namespace detail;
  if (!(x > -746)) return x != x ? x : 0.0;
  if (x > 710) return infinity;
  constexpr double per_step = double(64 / ln2);
  constexpr double step_hi = 0x1.62e42fefap-7;  // 33 bits of ln2 / 64: times a step count it is exact
  constexpr double step_lo = double(ln2 / 64 - step_hi);
  constexpr double rounding = 0x1.8p52;
  const double shifted = std::fma(x, per_step, rounding);
  const std::int64_t n = std::int64_t(std::bit_cast<std::uint64_t>(shifted) << 12) >> 12;
  const double steps = shifted - rounding;
  const double r = std::fma(-steps, step_lo, std::fma(-steps, step_hi, x));  // |r| < 0.0055
  const double r2 = r * r;
  const double q = std::fma(r2, std::fma(r, 1.0 / 720, 1.0 / 120), std::fma(r, 1.0 / 24, 1.0 / 6));
  const double expm1 = std::fma(r2, std::fma(r, q, 0.5), r);
  const std::int64_t low = n & 63;
  const std::int64_t exponent = (n - low) / 64;
  const double base = exp_table[low];
  const double value = std::fma(base, expm1, base);
  // Two factors, so that results below the normal range come out too.
  const std::int64_t half = exponent >> 1;
  return value * std::bit_cast<double>(std::uint64_t(half + 1023) << 52) *
         std::bit_cast<double>(std::uint64_t(exponent - half + 1023) << 52);
}

struct SinCos {
  double sin, cos;
};

// Sine and cosine of 2 pi u, for |u| < 2^50.
inline SinCos sincos_turns(double u) {
  const double quarter = std::nearbyint(4 * u);
  const double x = 2 * pi * (u - 0.25 * quarter);  // |x| <= pi / 4
  const double y = x * x;
  double s = 1.0 / 355687428096000;
  s = std::fma(s, y, -1.0 / 1307674368000);
  s = std::fma(s, y, 1.0 / 6227020800);
  s = std::fma(s, y, -1.0 / 39916800);
  s = std::fma(s, y, 1.0 / 362880);
  s = std::fma(s, y, -1.0 / 5040);
  s = std::fma(s, y, 1.0 / 120);
  s = std::fma(s, y, -1.0 / 6);
  s = std::fma(s * y, x, x);
  double c = 1.0 / 20922789888000;
  c = std::fma(c, y, -1.0 / 87178291200);
  c = std::fma(c, y, 1.0 / 479001600);
  c = std::fma(c, y, -1.0 / 3628800);
  c = std::fma(c, y, 1.0 / 40320);
  c = std::fma(c, y, -1.0 / 720);
  c = std::fma(c, y, 1.0 / 24);
  c = std::fma(c, y, -0.5);
  c = std::fma(c, y, 1.0);
  switch (std::int64_t(quarter) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

// The angle of (x, y) in [-pi, pi], as std::atan2; infinite coordinates only one at a time, and (0, 0) gives 0.
inline double atan2(double y, double x) {
  using namespace detail;
  const double ax = std::abs(x), ay = std::abs(y);
  const double small = ax < ay ? ax : ay, large = ax < ay ? ay : ax;
  double angle = 0;
  if (small > 0) {
    const double z = large == infinity ? 0.0 : small / large;
    const int i = int(z * 32 + 0.5);
    const double c = i / 32.0;
    // (z - c)/(1 + z c) from the two sides, so that the rounding of z does not enter: |t| <= 1/64
    const double t = z == 0 ? 0.0 : std::fma(-c, large, small) / std::fma(c, small, large);
    const double t2 = t * t;
    double p = -1.0 / 11;
    p = std::fma(p, t2, 1.0 / 9);
    p = std::fma(p, t2, -1.0 / 7);
    p = std::fma(p, t2, 1.0 / 5);
    p = std::fma(p, t2, -1.0 / 3);
    angle = atan_table[i] + std::fma(p * t2, t, t);
  }
  if (ax < ay) angle = pi / 2 - angle;
  if (std::signbit(x)) angle = pi - angle;
  return std::copysign(angle, y);
}

}  // namespace airlight::elementary
