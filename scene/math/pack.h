// Four doubles in one register, with the operators of a double, and the few functions that formulas need beside these.
// A formula written once as a template serves single numbers and packs, with the same bits.
#pragma once
#include <immintrin.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace airlight {

using Pack = double __attribute__((vector_size(32)));
using PackMask = decltype(Pack{} < Pack{});
inline constexpr int pack_size = 4;

template <class T>
T splat(double x);
template <>
inline double splat<double>(double x) {
  return x;
}
template <>
inline Pack splat<Pack>(double x) {
  return _mm256_set1_pd(x);
}

// a b + c with one rounding.
inline double madd(double a, double b, double c) { return std::fma(a, b, c); }
inline Pack madd(Pack a, Pack b, Pack c) { return _mm256_fmadd_pd(a, b, c); }
inline Pack madd(double a, Pack b, Pack c) { return madd(splat<Pack>(a), b, c); }
inline Pack madd(Pack a, double b, Pack c) { return madd(a, splat<Pack>(b), c); }
inline Pack madd(Pack a, double b, double c) { return madd(a, splat<Pack>(b), splat<Pack>(c)); }
inline Pack madd(Pack a, Pack b, double c) { return madd(a, b, splat<Pack>(c)); }

inline double pick(bool first, double a, double b) { return first ? a : b; }
inline Pack pick(PackMask first, Pack a, Pack b) { return first ? a : b; }

// b where a is not a number.
inline double smaller(double a, double b) { return a < b ? a : b; }
inline double larger(double a, double b) { return a > b ? a : b; }
inline Pack smaller(Pack a, Pack b) { return _mm256_min_pd(a, b); }
inline Pack larger(Pack a, Pack b) { return _mm256_max_pd(a, b); }

inline double absolute(double x) { return std::abs(x); }
inline Pack absolute(Pack x) { return _mm256_andnot_pd(splat<Pack>(-0.0), x); }
inline double root(double x) { return std::sqrt(x); }
inline Pack root(Pack x) { return _mm256_sqrt_pd(x); }

inline bool any(bool mask) { return mask; }
inline bool any(PackMask mask) { return _mm256_movemask_pd(std::bit_cast<__m256d>(mask)) != 0; }

inline double total(double x) { return x; }
inline double total(Pack x) { return (x[0] + x[2]) + (x[1] + x[3]); }

// 2^-n for the integer n in shifted = n + 1.5 * 2^52, |n| < 1023.
inline double power_of_half(double shifted) {
  return std::bit_cast<double>((std::uint64_t(1023) - std::bit_cast<std::uint64_t>(shifted)) << 52);
}
inline Pack power_of_half(Pack shifted) {
  using Bits = std::uint64_t __attribute__((vector_size(32)));
  return std::bit_cast<Pack>((1023 - std::bit_cast<Bits>(shifted)) << 52);
}

}  // namespace airlight
