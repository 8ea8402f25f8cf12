// Decomposition on the device: reconstruction, and the processor's numbers.
#include "gpu/wavelet_fog/grids.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "methods/wavelet_fog/options.h"
#include "tests/gpu/device.h"

namespace grids_test {

using namespace airlight;
using namespace airlight::gpu::wavelet_fog;
using wavelet_fog::Coefficients;
using wavelet_fog::Family;

namespace {

Coefficients random_map(int width, int height, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Coefficients c{{{0, 0}, {width, height}}, std::vector<double>(std::size_t(width) * height)};
  for (double& value : c.values) value = float(uniform(random));
  return c;
}

// Bands of one level on the device, and the grid that they were made of.
struct Split {
  int from, aa, ad, da, dd;
};
Split add_split(Grids& grids, int from, const Family& f) {
  const auto band = [&](const Taps& along_u, const Taps& along_v) {
    const int to = grids.add(coarse_range(grids.range(from), along_u, along_v));
    grids.reuse_scratch();
    grids.down(from, along_u, along_v, to);
    return to;
  };
  return {from, band(f.p_tilde, f.p_tilde), band(f.p_tilde, f.q_tilde), band(f.q_tilde, f.p_tilde),
          band(f.q_tilde, f.q_tilde)};
}
// The grid again, from a coarse grid and the details.
int add_join(Grids& grids, const Split& s, int coarse, const Family& f) {
  const int to = grids.add(grids.range(s.from));
  const auto add = [&](int band, const Taps& along_u, const Taps& along_v, int added) {
    grids.reuse_scratch();
    grids.up(band, along_u, along_v, to, added);
  };
  add(coarse, f.p, f.p, -1);
  add(s.ad, f.p, f.q, to);
  add(s.da, f.q, f.p, to);
  add(s.dd, f.q, f.q, to);
  return to;
}

double greatest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

DEVICE_TEST_CASE("wavelets on the GPU: reconstruction of any size and depth", "[gpu][wavelet_fog]") {
  const gpu::Use use(context);
  double worst = 0;
  for (const char* name : {"haar", "cdf22", "cdf33"})
    for (const auto& [width, height, levels] : std::vector<std::array<int, 3>>{
             {1, 1, 1}, {1, 17, 3}, {7, 5, 2}, {64, 64, 6}, {255, 129, 4}, {2048, 2048, 6}}) {
      const Family& f = wavelet_fog::family(name);
      if (width > 1000 && f.degree < 2) continue;  // seconds; the longest filters
      const Coefficients c = random_map(width, height, 3);
      Grids grids(context);
      grids.add(c.range);
      std::vector<Split> splits;
      for (int l = 0; l < levels; ++l) splits.push_back(add_split(grids, l == 0 ? 0 : splits.back().aa, f));
      int back = splits.back().aa;
      for (int l = levels; l-- > 0;) back = add_join(grids, splits[l], back, f);
      grids.allocate();
      grids.upload(c.values);
      grids.run();
      const double error = greatest_difference(grids.download(back), c.values);
      CAPTURE(name, width, height, levels);
      CHECK(error <= 2e-6);
      worst = std::max(worst, error);
      // The processor's approximation, exact where they agree that far.
      const auto coarse = approximations(c, f.p_tilde, levels);
      CHECK(greatest_difference(grids.download(splits.back().aa), coarse.back().values) <= 2e-6);
    }
  UNSCOPED_INFO("worst reconstruction " << worst);
  CHECK(worst > 0);  // single precision was at work
}

DEVICE_TEST_CASE("wavelets on the GPU: restricted and clamped grids are the processor's", "[gpu][wavelet_fog]") {
  const gpu::Use use(context);
  for (int degree = 0; degree <= 3; ++degree)
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1}, {33, 20}, {130, 257}}) {
      const Coefficients c = random_map(width, height, 8);
      const Taps low = wavelet_fog::restriction(degree);
      Grids grids(context);
      grids.add(c.range);
      const int coarse = grids.add(coarse_range(c.range, low, low));
      grids.down(0, low, low, coarse);
      // Wavelets' coarse grids have values below 0; degree 3 has none.
      const bool clamps = degree < 3;
      const Taps analysis = clamps ? wavelet_fog::family(wavelet_fog::family_of_degree(degree)).p_tilde : low;
      const int pure = grids.add(coarse_range(c.range, analysis, analysis)), clamped = grids.add(grids.range(pure), 2);
      grids.down(0, analysis, analysis, pure);
      grids.clamp(pure, clamped);
      grids.allocate();
      grids.upload(c.values);
      grids.run();
      CAPTURE(degree, width, height);
      CHECK(greatest_difference(grids.download(coarse), approximations(c, low, 1)[1].values) <= 3e-7);
      CHECK(greatest_difference(grids.download(clamped),
                                wavelet_fog::clamped(approximations(c, analysis, 1)[1]).values) <= 1e-6);
    }
}

}  // namespace grids_test
