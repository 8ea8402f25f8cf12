// Maps of few coefficients, and of another degree.
#include "methods/wavelet_fog/compression.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace compression_test {

using namespace airlight;
using namespace airlight::wavelet_fog;

namespace {

// Values in [0, 1), a third of them 0.
Coefficients random_map(int width, int height, std::uint32_t seed) {
  Coefficients c{{{0, 0}, {width, height}}, {}};
  std::uint64_t state = seed;
  for (int i = 0; i < width * height; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    const double value = double(state >> 40) / double(1 << 24);
    c.values.push_back(value < 1.0 / 3 ? 0 : value);
  }
  return c;
}

const char* const families[] = {"haar", "cdf22", "cdf33"};

}  // namespace

TEST_CASE("wavelet fog: a map of all its coefficients is the map, one of fewer the closer the more there are",
          "[wavelet_fog]") {
  for (int degree = 0; degree <= 2; ++degree) {
    const Coefficients c = random_map(32, 24, 3);
    const Family& f = family(families[degree]);
    double before = 2;
    for (const double keep : {0.0, 0.05, 0.2, 0.6, 0.9}) {
      const Compressed some = compress(c, f, 3, keep);
      CAPTURE(degree, keep);
      CHECK(some.kept == long(std::ceil(keep * 32 * 24)));
      CHECK(some.error < before);
      for (const double value : some.map.values) REQUIRE(value >= 0);
      before = some.error;
    }
    CHECK(compress(c, f, 3, 0).error == Approx(1).epsilon(1e-14));
    const Compressed all = compress(c, f, 3, 10);  // more than the growing ranges can hold
    CHECK(all.error <= 1e-14);
  }
}

TEST_CASE("wavelet fog: the norm of a map", "[wavelet_fog]") {
  const double alone[] = {1, 2.0 / 3, 11.0 / 20, 151.0 / 315};  // integrals of N_n squared
  for (int degree = 0; degree <= 3; ++degree) {
    const Coefficients one{{{4, -2}, {3, 2}}, {0, 0, 3, 0, 0, 0}};
    CHECK(l2_norm(one, degree) == Approx(3 * alone[degree]).epsilon(1e-14));
    const Coefficients flat{{{0, 0}, {200, 200}}, std::vector<double>(40000, 0.5)};
    CHECK(l2_norm(flat, degree) == Approx(0.5 * 200).epsilon(0.01));
  }
}

TEST_CASE("wavelet fog: of equal weights the same coefficients are kept every time", "[wavelet_fog]") {
  Coefficients c{{{0, 0}, {64, 64}}, std::vector<double>(64 * 64, 0.0)};
  for (int k = 0; k < 40; ++k) c.values[std::size_t(k * 97 % 4096)] = 1;
  const Compressed first = compress(c, family("haar"), 4, 0.01);
  for (int i = 0; i < 5; ++i) {
    const std::vector<std::vector<double>> elsewhere(std::size_t(i) + 1,
                                                     std::vector<double>(1000));  // moves what is allocated
    CHECK(compress(c, family("haar"), 4, 0.01).map.values == first.map.values);
  }
}

// Haar's wavelets are orthogonal: what is left out is its own norm, and a wavelet's norm is its height times the side of its square.
TEST_CASE("wavelet fog: of coefficients of all sizes those are kept that the map's norm needs most", "[wavelet_fog]") {
  Coefficients c{{{0, 0}, {8, 8}}, std::vector<double>(64, 5.0)};
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 8; ++i) {
      double& value = c.values[std::size_t(8 * j + i)];
      value += i < 4 ? 0.4 : -0.4;                   // one wavelet of norm 0.4 * 8
      if (i < 2 && j < 2) value += i == j ? 1 : -1;  // one of norm 1 * 2
    }
  const double norm = std::sqrt(64 * 25 + 64 * 0.16 + 4);
  CHECK(l2_norm(c, 0) == Approx(norm).epsilon(1e-14));
  CHECK(compress(c, family("haar"), 3, 1.0 / 64).error == Approx(std::sqrt(64 * 0.16 + 4) / norm).epsilon(1e-12));
  CHECK(compress(c, family("haar"), 3, 2.0 / 64).error == Approx(2 / norm).epsilon(1e-12));
  CHECK(compress(c, family("haar"), 3, 3.0 / 64).error < 1e-14);
}

}  // namespace compression_test
