// Gaussians four at a time, coordinate by coordinate: short loops over the lanes become SIMD code.
#pragma once
#include <immintrin.h>

#include <array>
#include <cstddef>

#include "scene/media/gaussian_line.h"

namespace airlight::scene {

inline constexpr int lanes = 4;
using Lanes = std::array<double, lanes>;

inline double total(const Lanes& v) { return (v[0] + v[2]) + (v[1] + v[3]); }

struct GaussianBlock {
  alignas(32) Lanes x, y, z, width, amplitude;

  // A transposition in registers: copied one by one the numbers would stall the wide loads that follow.
  explicit GaussianBlock(const Gaussian* g) {
    const __m256d a = _mm256_loadu_pd(g[0].center.data()), b = _mm256_loadu_pd(g[1].center.data());
    const __m256d c = _mm256_loadu_pd(g[2].center.data()), d = _mm256_loadu_pd(g[3].center.data());
    const __m256d ab_even = _mm256_unpacklo_pd(a, b), ab_odd = _mm256_unpackhi_pd(a, b);
    const __m256d cd_even = _mm256_unpacklo_pd(c, d), cd_odd = _mm256_unpackhi_pd(c, d);
    _mm256_store_pd(x.data(), _mm256_permute2f128_pd(ab_even, cd_even, 0x20));
    _mm256_store_pd(y.data(), _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20));
    _mm256_store_pd(z.data(), _mm256_permute2f128_pd(ab_even, cd_even, 0x31));
    _mm256_store_pd(width.data(), _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31));
    _mm256_store_pd(amplitude.data(), _mm256_set_pd(g[3].amplitude, g[2].amplitude, g[1].amplitude, g[0].amplitude));
  }

  GaussianLine line(int k, const Ray& ray) const {
    return gaussian_line(x[k], y[k], z[k], width[k], amplitude[k], ray);
  }
};
static_assert(sizeof(Gaussian) == 5 * sizeof(double) && offsetof(Gaussian, width) == 3 * sizeof(double));

// Calls f(block) for all Gaussians; what is missing in the last block are Gaussians of amplitude 0.
template <class F>
void for_each_block(const std::vector<Gaussian>& gaussians, F&& f) {
  const std::size_t n = gaussians.size(), whole = n - n % lanes;
  for (std::size_t first = 0; first < whole; first += lanes) f(GaussianBlock(gaussians.data() + first));
  if (whole == n) return;
  Gaussian rest[lanes];
  for (int k = 0; k < lanes; ++k) rest[k] = whole + k < n ? gaussians[whole + k] : Gaussian{Point3::Zero(), 1, 0};
  f(GaussianBlock(rest));
}

}  // namespace airlight::scene
