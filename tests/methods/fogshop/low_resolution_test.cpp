#include "methods/fogshop/low_resolution.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/fogshop/fogshop.h"
#include "tests/pictures.h"

namespace low_resolution_test {

using namespace airlight;
using namespace airlight::fogshop;
using Pairs = std::map<std::string, std::string>;
using airlight::test::relative_l2;

namespace {

std::size_t low_count(const LowResolution& r) { return std::size_t(r.low_width()) * r.low_height(); }

// A low picture whose airlight and depth are `value` at the middle of each block, in film pixels.
template <class Value>
AirlightImage low_picture(const LowResolution& r, const Value& value) {
  AirlightImage low;
  for (int y = 0; y < r.low_height(); ++y)
    for (int x = 0; x < r.low_width(); ++x) {
      const double v = value(r.factor * (x + 0.5), r.factor * (y + 0.5));
      low.airlight.push_back(Rgb(v, 2 * v, 3 * v));
      low.depth.push_back(4 * v);
    }
  return low;
}

scene::Scene posts(int width, int height) {
  return scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/posts.toml",
                           {{"film.width", std::to_string(width)}, {"film.height", std::to_string(height)}});
}

scene::Rendering render(const scene::Scene& scene, const Pairs& given, int threads = 1) {
  return airlight::test::render(Fogshop(), scene, given, threads);
}

}  // namespace

// With one low pixel per pixel both rules must give back the picture, bit by bit, edges and infinite distances
// included.
TEST_CASE("upsampling by 1 is the identity", "[fogshop]") {
  const LowResolution r{13, 9, 1};
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> random;
  AirlightImage low;
  std::vector<double> distance;
  for (std::size_t i = 0; i < low_count(r); ++i) {
    low.airlight.push_back(Rgb(random(generator), random(generator), random(generator)));
    low.depth.push_back(10 * random(generator));
    distance.push_back(i % 5 == 0 ? infinity : 1 + i % 3);
  }
  const auto edge = edge_pixels(r, distance, distance);
  CHECK(std::count(edge.begin(), edge.end(), 1) > 50);
  for (const std::vector<unsigned char>& edges : {edge, std::vector<unsigned char>{}}) {
    const AirlightImage image = upsample(r, low, edges, distance, distance);
    CHECK(image.depth == low.depth);
    for (std::size_t i = 0; i < low.airlight.size(); ++i) CHECK((image.airlight[i] == low.airlight[i]).all());
  }
}

// A constant stays, everywhere; a + b x + c y + d x y stays wherever all four neighbours are there. Weights are
// multiples of 1/64, so that values of few bits are exact.
TEST_CASE("upsampling keeps constants and bilinear fields", "[fogshop]") {
  for (const int factor : {2, 4})
    for (const auto& [width, height] : {std::pair{16, 12}, std::pair{17, 11}}) {
      const LowResolution r{width, height, factor};
      const std::vector<double> low_distance(low_count(r), 5.0), distance(std::size_t(width) * height, 5.0);
      const auto edge = edge_pixels(r, low_distance, distance);
      CHECK(std::count(edge.begin(), edge.end(), 1) == 0);
      const auto field = [](double x, double y) { return 3 + 0.5 * x - 0.25 * y + 0.125 * x * y; };
      const AirlightImage flat = upsample(r, low_picture(r, [](double, double) { return 0.75; }), edge, {}, {});
      const AirlightImage tilted = upsample(r, low_picture(r, field), edge, {}, {});
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const std::size_t i = std::size_t(y) * width + x;
          CHECK(flat.depth[i] == 3.0);
          CHECK(flat.airlight[i][2] == 2.25);
          const double u = x + 0.5, v = y + 0.5, least = 0.5 * factor;
          if (u < least || v < least || u > factor * (r.low_width() - 0.5) || v > factor * (r.low_height() - 0.5))
            continue;
          CHECK(tilted.depth[i] == 4 * field(u, v));
          CHECK(tilted.airlight[i][1] == 2 * field(u, v));
        }
    }
}

// A ratio of 1.1 between distances makes an edge, for the pixels that have both in their neighbourhood.
TEST_CASE("edges begin at a ratio of 1.1", "[fogshop]") {
  const LowResolution r{16, 16, 2};
  for (const auto& [far, is_edge] : {std::pair{1.0999, false}, std::pair{1.1001, true}, std::pair{infinity, true}}) {
    std::vector<double> low_distance(low_count(r), 1.0), distance(256, 1.0);
    for (int i = 0; i < 256; ++i)
      if (i % 16 >= 8) distance[i] = far;
    for (std::size_t i = 0; i < low_distance.size(); ++i)
      if (i % 8 >= 4) low_distance[i] = far;
    const auto edge = edge_pixels(r, low_distance, distance);
    // Columns 7 and 8 lie between the low pixels 3 and 4, and see one another; 6 and 9 see neither.
    for (int x = 0; x < 16; ++x) CHECK(int(edge[5 * 16 + x]) == int(is_edge && (x == 7 || x == 8)));
  }
  const std::vector<double> open(low_count(r), infinity), all(256, infinity);
  const auto edge = edge_pixels(r, open, all);
  CHECK(std::count(edge.begin(), edge.end(), 1) == 0);
}

// Balls and thin posts in fog against the same at full resolution. The specification's bound for the transmittance at
// factor 2 is 0.03; edges that are computed again have the bits of full resolution.
TEST_CASE("low resolution in a scene with edges", "[fogshop]") {
  const scene::Scene scene = posts(160, 120);
  const scene::Rendering full = render(scene, {{"K", "8"}});
  CHECK(full.counters.count("pixels_edge") == 0);
  for (const auto& time : full.times) CHECK(time.name != "upsampling");
  for (const char* factor : {"2", "4"}) {
    const auto low = [&](const char* upsample) {
      return render(scene, {{"K", "8"}, {"downsample", factor}, {"upsample", upsample}});
    };
    const scene::Rendering bilinear = low("bilinear"), paper = low("paper"), again = low("recompute");
    const auto& truth = full.film.layer("airlight");
    const double errors[] = {relative_l2(bilinear.film.layer("airlight"), truth),
                             relative_l2(paper.film.layer("airlight"), truth),
                             relative_l2(again.film.layer("airlight"), truth)};
    const double edges = again.counters.at("pixels_edge") / (160 * 120);
    double lost = 0;
    std::size_t same = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const float t = full.film.layer("transmittance")[i];
      const float now = again.film.layer("airlight")[i];
      lost = std::max(lost, std::abs(double(again.film.layer("transmittance")[i]) - t));
      same += now == truth[i];
      CHECK((now == truth[i] || now == bilinear.film.layer("airlight")[i]));
    }
    INFO("factor " << factor << ": bilinear, paper, recompute " << errors[0] << " " << errors[1] << " " << errors[2]
                   << ", edges " << edges << ", transmittance off by " << lost);
    CHECK(errors[1] < errors[0]);
    CHECK(errors[2] < 0.2 * errors[1]);
    CHECK(lost <= 0.03);
    CHECK(double(same) / double(truth.size()) >= edges);
    CHECK(again.counters.at("gaussians_crossed") < 0.6 * full.counters.at("gaussians_crossed"));
  }
}

TEST_CASE("low resolution: same bits on one thread and on two, sizes that no factor divides", "[fogshop]") {
  const scene::Scene scene = posts(43, 31);
  for (const char* upsample : {"bilinear", "paper", "recompute"}) {
    const Pairs given{{"K", "8"}, {"downsample", "4"}, {"upsample", upsample}};
    const scene::Rendering one = render(scene, given, 1), two = render(scene, given, 2);
    CHECK(one.film.layers == two.film.layers);
    CHECK(one.counters.at("pixels_low") == 11 * 8);
  }
}

}  // namespace low_resolution_test
