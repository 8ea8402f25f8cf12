// Decomposition and levels: exact reconstruction, the identities that the variants stand on.
#include "methods/wavelet_fog/decomposition.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

#include "methods/wavelet_fog/blocks.h"
#include "methods/wavelet_fog/options.h"

namespace decomposition_test {

using namespace airlight;
using namespace airlight::wavelet_fog;

namespace {

Coefficients random_map(int width, int height, unsigned seed, double empty = 0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Coefficients c{{{0, 0}, {width, height}}, std::vector<double>(std::size_t(width) * height)};
  for (double& value : c.values) value = uniform(random);
  // Patches of 5 x 5 without fog.
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      std::mt19937_64 patch(seed + 7919u * unsigned(i / 5) + 104729u * unsigned(j / 5));
      if (uniform(patch) < empty) c.values[std::size_t(j) * width + i] = 0;
    }
  return c;
}

// Hills of fog, wide enough for coarse grids, between flat ground without any.
Coefficients hills(int side, double phase) {
  Coefficients c{{{0, 0}, {side, side}}, {}};
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      c.values.push_back(std::max(0.0, std::sin(0.13 * i + phase) * std::sin(0.11 * j + 2 * phase)));
  return c;
}

scene::MapLine random_line(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> u(-0.2 * size, 1.2 * size), h(-1, 3);
  const double angle = std::uniform_real_distribution<double>(0, 2 * pi)(random);
  return {u(random), u(random), h(random), std::cos(angle), std::sin(angle), 0.3 * h(random)};
}

const std::string families[] = {family_of_degree(0), family_of_degree(1), family_of_degree(2)};

}  // namespace

TEST_CASE("wavelets: coarse grids keep the mass, restricted and clamped ones their sign", "[wavelet_fog]") {
  for (int degree = 0; degree <= 3; ++degree) {
    const Coefficients c = random_map(33, 20, 8, 0.5);
    const double mass = std::accumulate(c.values.begin(), c.values.end(), 0.0);
    for (const Coefficients& coarse : approximations(c, restriction(degree), 3))
      CHECK(*std::min_element(coarse.values.begin(), coarse.values.end()) >= 0);
    const auto sums = approximations(c, restriction(degree), 3);
    CHECK(std::accumulate(sums[3].values.begin(), sums[3].values.end(), 0.0) * 64 == Approx(mass).epsilon(1e-13));
    if (degree == 3) continue;
    const auto analysed = approximations(c, family(families[degree]).p_tilde, 3);
    const double kept = std::accumulate(analysed[3].values.begin(), analysed[3].values.end(), 0.0);
    const Coefficients positive = clamped(analysed[3]);
    CHECK(kept * 64 == Approx(mass).epsilon(1e-13));
    CHECK(*std::min_element(positive.values.begin(), positive.values.end()) >= 0);
    CHECK(std::accumulate(positive.values.begin(), positive.values.end(), 0.0) == Approx(kept).epsilon(1e-13));
  }
}

TEST_CASE("wavelet fog: a map of degree 3 is rendered without wavelets, which it has none of", "[wavelet_fog]") {
  const Coefficients c = random_map(6, 5, 2);
  const scene::SplineMap map(3, c.range, c.values);
  for (const Coarse coarse : {Coarse::wavelet, Coarse::clamped, Coarse::restricted})
    CHECK(make_levels(map, family_of_degree(3), coarse, 0, false).count() == 0);
  CHECK_THROWS(make_levels(map, family_of_degree(3), Coarse::wavelet, 1, false));
  CHECK(make_levels(map, family_of_degree(3), Coarse::restricted, 1, false).count() == 1);
}

TEST_CASE("wavelet fog: levels summed equal one grid at a time, and the map where all count", "[wavelet_fog]") {
  std::mt19937_64 random(4);
  for (int degree = 0; degree <= 2; ++degree)
    for (const Coarse coarse : {Coarse::wavelet, Coarse::restricted})
      for (const double mu : {1.0, 0.7, 0.2, 0.0}) {
        const Coefficients c = random_map(40, 40, 21 + degree, 0.5);
        const scene::SplineMap map(degree, c.range, c.values);
        const Levels levels = make_levels(map, families[degree], coarse, 3, true);
        const scene::HeightProfile profile = scene::ExponentialFall{0, 1.5};
        for (int i = 0; i < 60; ++i) {
          const scene::MapLine line = random_line(random, 40);
          const double length = length_in_box(levels, line, 70);
          Visits visits;
          const Interval all{0, infinity};
          const double sum = summed_depth(levels, profile, line, all, length, mu, visits);
          const double one = telescoped_depth(levels, profile, line, all, length, mu, visits);
          CAPTURE(degree, mu, i);
          REQUIRE(one == Approx(sum).epsilon(1e-12).margin(1e-13));
          if (mu == 1)
            REQUIRE(one == Approx(scene::integral(map, profile, line, {0, length})).epsilon(1e-12).margin(1e-13));
        }
      }
}

// Columns of 1 and 0: a block of two is 1/2, off by 1/2 all along a ray that stays in one of them. Its error is its bound.
TEST_CASE("wavelet fog: a bound below the error of a block asks for its cells", "[wavelet_fog]") {
  Coefficients c{{{0, 0}, {8, 8}}, std::vector<double>(64)};
  for (std::size_t at = 0; at < c.values.size(); ++at) c.values[at] = at % 2 ? 0 : 1;
  const Levels levels = make_levels(scene::SplineMap(0, c.range, c.values), "haar", Coarse::wavelet, 1, false);
  const Blocks blocks(levels, 1, true);
  const scene::MapLine line{4.1, 2.5, 0, 1, 0, 0};
  const auto depth = [&](double most) {
    Visits visits;
    return bounded_depth(levels, blocks, scene::SameAtAllHeights{}, line, {0, 0.8}, most, infinity, visits);
  };
  CHECK(depth(0.51) == Approx(0.4).epsilon(1e-12));
  for (const double most : {0.49, 0.3, 0.01}) CHECK(depth(most) == Approx(0.8).epsilon(1e-12));
}

// A ramp is equal on every grid over whole steps. A level leaves out the way beyond its reach, length mu^m.
TEST_CASE("wavelet fog: the m-th level of details reaches mu^m of the way", "[wavelet_fog]") {
  Coefficients c{{{0, 0}, {64, 64}}, std::vector<double>(64 * 64, 0.0)};
  for (std::size_t at = 0; at < c.values.size(); ++at) c.values[at] = 0.01 * double(at % 64);  // a ramp along u
  const Levels levels = make_levels(scene::SplineMap(0, c.range, c.values), "haar", Coarse::restricted, 2, true);
  const scene::HeightProfile profile = scene::SameAtAllHeights{};
  // Along u from cell 4: a grid l levels up has steps of 2^l cells.
  const auto depth = [](double from, double to, int step) {
    double sum = 0;
    for (double t = from; t < to; t += 1) sum += 0.01 * (std::floor((4 + t) / step) * step + 0.5 * (step - 1));
    return sum;
  };
  Visits visits;
  const scene::MapLine line{4, 32.5, 0, 1, 0, 0};
  const double found = telescoped_depth(levels, profile, line, {0, infinity}, 36, 0.5, visits);
  // The finest to 36 mu^2 = 9 cells, the next to 18, the coarsest to the end; these ends lie within steps, where the grids differ.
  CHECK(found == Approx(depth(0, 9, 1) + depth(9, 18, 2) + depth(18, 36, 4)).epsilon(1e-12));
  CHECK(found != Approx(depth(0, 36, 1)).epsilon(1e-4));
}

TEST_CASE("wavelet fog: skipping is exact, bounds keep their tolerance", "[wavelet_fog]") {
  std::mt19937_64 random(9);
  for (int degree = 0; degree <= 2; ++degree) {
    const Coefficients c = hills(64, 0.3 + degree);
    const scene::SplineMap map(degree, c.range, c.values);
    const Levels levels = make_levels(map, families[degree], Coarse::wavelet, 4, false);
    const Blocks blocks(levels, 4, true);
    const scene::HeightProfile profile = scene::Layers{{0, 1, 3}, {1, 0.5, 0.1}};
    Visits exact, skipped;
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const scene::MapLine line = random_line(random, 64);
      const Interval t{0, 90};
      Visits visits;
      const double direct = integral_of_level(map, 0, profile, line, t, exact);
      REQUIRE(skipped_depth(levels, blocks, profile, line, t, infinity, skipped) ==
              Approx(direct).epsilon(1e-12).margin(1e-13));
      for (const double tolerance : {0.3, 0.03, 0.001}) {
        const double bounded =
            bounded_depth(levels, blocks, profile, line, t, tolerance / t.length(), infinity, visits);
        REQUIRE(std::abs(bounded - direct) <= tolerance);
        worst = std::max(worst, std::abs(bounded - direct) / tolerance);
      }
    }
    CHECK(skipped.cells < 0.6 * exact.cells);
    CHECK(worst > 1e-3);  // coarse grids were read
  }
}

}  // namespace decomposition_test
