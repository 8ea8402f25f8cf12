// The blur, and upsampling from blocks to pixels.
#include "reference/half_resolution_march/filter.h"

#include <catch2/catch.hpp>

namespace half_filter_test {

using namespace airlight;
using namespace airlight::half_resolution_march;

namespace {

constexpr double rounding = 1e-6;  // of sums of 11 floats

// Depths with an edge along a slanted line, and nothing behind it in some pixels.
LowFilm film_with_edges(int width, int height, int divide) {
  LowFilm film(width, height, divide);
  film.depth.resize(film.fog.size());
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x)
      film.depth[film.at(x, y)] = 2 * x > 3 * y + 4 ? infinity : x > y ? 5 + 0.01 * x : 2;
  return film;
}

void fill(LowFilm& film, float value) {
  for (FogPixel& fog : film.fog) fog.setConstant(value);
}

void check_constant(const LowFilm& film, float value) {
  double most = 0;
  for (const FogPixel& fog : film.fog) most = std::max(most, double((fog - value).abs().maxCoeff()));
  CHECK(most <= rounding * value);
}

}  // namespace

TEST_CASE("half-resolution march: the blur keeps a constant, also across edges of depth", "[half_resolution_march]") {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {40, 30}, {7, 100}}) {
    CAPTURE(width, height);
    LowFilm flat(width, height, 2), edged = film_with_edges(width, height, 2);
    for (LowFilm* film : {&flat, &edged}) {
      fill(*film, 0.7f);
      blur(*film, 1e-3, {});
      check_constant(*film, 0.7f);
      blur(*film, 1e9, {});
      check_constant(*film, 0.7f);
    }
  }
}

// A bright point inside the film shows the blur's weights: they add up to 1, are a Gaussian cut at 5 pixels, and are equal in all channels.
TEST_CASE("half-resolution march: the blur of a point is a Gaussian of weight 1", "[half_resolution_march]") {
  LowFilm film(60, 60, 2);
  fill(film, 0);
  film.fog[film.at(15, 14)].setOnes();
  blur(film, 1, {});
  double line[11], total = 0;
  for (int i = -5; i <= 5; ++i) total += line[i + 5] = std::exp(-i * i / (2 * std::pow(5 / 1.5, 2)));
  double sum = 0, most = 0;
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) {
      const int dx = x - 15, dy = y - 14;
      const bool inside = std::abs(dx) <= 5 && std::abs(dy) <= 5;
      const double expected = inside ? line[dx + 5] * line[dy + 5] / (total * total) : 0;
      for (int c = 0; c < 8; ++c) most = std::max(most, std::abs(film.fog[film.at(x, y)][c] - expected));
      sum += film.fog[film.at(x, y)][0];
    }
  CHECK(most < rounding);
  CHECK(sum == Approx(1).margin(rounding));
}

// Two halves, 1 before the edge and 0 behind it. The pixel before the edge keeps its own half's share of the weights.
// The weights of the other half are multiplied by exp(-(dz / edge)^2).
TEST_CASE("half-resolution march: the blur stops at edges of depth", "[half_resolution_march]") {
  double half = 0;  // of weights, beside the middle one
  for (int i = 1; i <= 5; ++i) half += std::exp(-i * i / (2 * std::pow(5 / 1.5, 2)));
  for (const double apart : {0.0, 0.5, 1.0, 30.0, infinity}) {
    LowFilm film(40, 1, 1);
    film.depth.resize(film.fog.size());
    for (std::size_t x = 0; x < 40; ++x) {
      film.fog[x].setConstant(x < 20 ? 1.0f : 0.0f);
      film.depth[x] = x < 20 ? 4.0 : 4.0 + apart;
    }
    blur(film, 1, {});
    const double through = std::exp(-apart * apart);
    CAPTURE(apart);
    CHECK(film.fog[19][0] == Approx((1 + half) / (1 + half + half * through)).epsilon(rounding));
    CHECK(film.fog[20][0] == Approx(half * through / (1 + half + half * through)).margin(rounding));
  }
}

TEST_CASE("half-resolution march: blocks cover the film, whatever its size", "[half_resolution_march]") {
  for (const int pixels : {1, 2, 3, 5, 8, 9, 100})
    for (const int divide : {1, 2, 3, 8, 64}) {
      const Blocks blocks{pixels, divide};
      CAPTURE(pixels, divide);
      CHECK(blocks.begin(0) == 0);
      CHECK(blocks.end(blocks.count() - 1) == pixels);
      for (int b = 0; b < blocks.count(); ++b) {
        CHECK(blocks.begin(b) < blocks.end(b));
        if (b > 0) CHECK(blocks.begin(b) == blocks.end(b - 1));
      }
      for (int x = 0; x < pixels; ++x) {
        const Neighbours n = neighbours(blocks, x);
        CHECK((n.first >= 0 && n.first <= n.second && n.second < blocks.count()));
        CHECK((n.share >= 0 && n.share < 1));
        // Linear between the blocks' centres, constant beyond them.
        const double at = (1 - n.share) * blocks.center(n.first) + n.share * blocks.center(n.second);
        CHECK(at == Approx(std::clamp(x + 0.5, blocks.center(0), blocks.center(blocks.count() - 1))).epsilon(1e-14));
      }
    }
}

TEST_CASE("half-resolution march: upsampling keeps a constant, and is the identity at full resolution",
          "[half_resolution_march]") {
  for (const bool nearest : {false, true})
    for (const int divide : {1, 2, 5}) {
      LowFilm film = film_with_edges(23, 17, divide);
      fill(film, 0.3f);
      for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 23; ++x) {
          const double depth = (x + y) % 3 == 0 ? infinity : 1 + 0.2 * x;
          const FogPixel fog =
              upsampled(film, neighbours(film.across, x), neighbours(film.down, y), depth, nearest, 0.5);
          CHECK((fog - 0.3f).abs().maxCoeff() < rounding);
        }
      if (divide > 1) continue;
      for (std::size_t i = 0; i < film.fog.size(); ++i) film.fog[i].setConstant(float(std::sin(double(i * i))));
      for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 23; ++x) {
          const FogPixel fog = upsampled(film, neighbours(film.across, x), neighbours(film.down, y),
                                         film.depth[film.at(x, y)], nearest, 0.5);
          CHECK((fog == film.fog[film.at(x, y)]).all());
        }
    }
}

// Beyond an edge the nearest depth is taken alone; between equal ones the nearer block.
TEST_CASE("half-resolution march: upsampling takes the neighbour of nearest depth at edges",
          "[half_resolution_march]") {
  LowFilm film(4, 4, 2);
  film.depth = {1, 3, infinity, infinity};
  for (int k = 0; k < 4; ++k) film.fog[k].setConstant(float(k + 1));
  const auto at = [&](int x, int y, double depth, double edge = 0.1) {
    return upsampled(film, neighbours(film.across, x), neighbours(film.down, y), depth, true, edge)[0];
  };
  CHECK(at(1, 1, 1.2) == 1);
  CHECK(at(1, 1, 2.9) == 2);
  CHECK(at(1, 1, infinity) == 3);
  CHECK(at(2, 1, infinity) == 4);
  film.depth = {1, 1, 1, 1.1};
  // 0.1 of difference in all: an edge only where 0.75 of `edge` are less.
  CHECK(at(1, 1, 1, 0.14) == Approx((9 * 1 + 3 * 2 + 3 * 3 + 4) / 16.0).epsilon(rounding));
  CHECK(at(1, 1, 1, 0.12) == 1);
}

}  // namespace half_filter_test
