// The paper's sum before deconstruction, and its tables of path integrals.
#include "methods/wavelet_fog/band_grid.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/wavelet_fog/options.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "scene/media/fogmap.h"
#include "tests/pictures.h"

namespace band_grid_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::wavelet_fog;

namespace {

const WaveletFog method;

scene::SplineMap map_of(int degree, int width, int height) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values(std::size_t(width) * height);
  for (double& value : values) value = uniform(random);
  return {degree, {{0, 0}, {width, height}}, values};
}

scene::MapLine random_line(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> place(-0.2 * size, 1.2 * size), height(-1, 3);
  const double angle = std::uniform_real_distribution<double>(0, 2 * pi)(random);
  return {place(random), place(random), height(random), std::cos(angle), std::sin(angle), 0.3 * height(random)};
}

}  // namespace

TEST_CASE("wavelet fog: bands of wavelets equal the splines that deconstruction makes of them", "[wavelet_fog]") {
  const scene::HeightProfile profiles[] = {scene::SameAtAllHeights{}, scene::Layers{{0, 1, 3}, {1, 0.5, 0.1}},
                                           scene::ExponentialFall{0.5, 0.8}};
  std::mt19937_64 random(4);
  for (int degree = 0; degree <= 2; ++degree) {
    const scene::SplineMap map = map_of(degree, 37, 21);
    const Family& wavelets = family(family_of_degree(degree));
    const Levels levels = make_levels(map, wavelets.name, Coarse::wavelet, 3, true);
    const Decomposition d = decompose({map.range(), map.coefficients()}, wavelets, 3);
    for (const scene::HeightProfile& profile : profiles)
      for (int l = 1; l <= 3; ++l) {
        const BandGrid bands(d.levels[l - 1], wavelets, l), splines(levels.detail[l - 1], l - 1);
        for (int i = 0; i < 100; ++i) {
          const scene::MapLine line = random_line(random, 37);
          const Interval t{0, 3 + 0.3 * i};
          Visits of_bands, of_splines, of_walk;
          const double expected = integral_of_level(levels.detail[l - 1], l - 1, profile, line, t, of_walk);
          CAPTURE(degree, l, i);
          REQUIRE(bands.integral(profile, line, t, nullptr, of_bands) == Approx(expected).epsilon(1e-11).margin(1e-12));
          REQUIRE(splines.integral(profile, line, t, nullptr, of_splines) ==
                  Approx(expected).epsilon(1e-11).margin(1e-12));
          if (profile.index() == 0) CHECK(of_splines.coefficients == of_walk.coefficients);
          // Twice the bands' support in phi psi, once in psi psi: what a cell costs before deconstruction.
          const int w[] = {1, 3, 5}, n = degree + 1;
          CHECK(of_bands.coefficients == of_bands.cells * (2 * n * w[degree] + w[degree] * w[degree]));
        }
      }
  }
}

TEST_CASE("wavelet fog: tables of path integrals have the paper's sizes, and are exact at their places",
          "[wavelet_fog]") {
  const int tables[] = {4, 25, 64};
  for (int degree = 0; degree <= 2; ++degree) {
    const UnitPieces pieces{degree, family(family_of_degree(degree)).q};
    for (const PathTable::Lookup lookup : {PathTable::Lookup::nearest, PathTable::Lookup::bilinear}) {
      const PathTable table(pieces, 8, lookup);
      CHECK(table.values().size() == std::size_t(tables[degree]) * 32 * 32);
      // The scaling functions sum up to 1, so that their integrals sum up to the length of the way; a wavelet's to those of
      // its splines.
      std::vector<double> out(tables[degree]);
      for (int entry = 0; entry < 32; ++entry)
        for (int exit = 0; exit < 32; ++exit) {
          table.integrals(entry / 8.0, exit / 8.0, out.data());
          double sum = 0;
          for (int a = 0; a <= degree; ++a)
            for (int b = 0; b <= degree; ++b) sum += out[a * pieces.count() + b];
          const double length = (PathTable::point(exit / 8.0) - PathTable::point(entry / 8.0)).norm();
          REQUIRE(sum == Approx(length).epsilon(1e-6).margin(1e-7));
        }
    }
  }
}

TEST_CASE("wavelet fog: error of the tables falls with their resolution", "[wavelet_fog]") {
  // 800 segments over patchy fog, relative to their mean optical depth. Places are known to half of 1/R: nearest is of
  // first order. Between places the length of a way is convex (a cone near corners), so that bilinear is biased upwards: worse
  // than nearest at R = 8, and of second order.
  const double most[2][4] = {{4.6e-3, 1.9e-3, 9e-4, 4.6e-4}, {6.3e-3, 1.9e-3, 5.6e-4, 1.8e-4}};
  const scene::SplineMap patchy =
      std::get<scene::FogmapPointer>(scene_named("wavelet_fog/patchy", 4, 4)->media[0].field)->map;
  for (const int degree : {0, 1, 2}) {
    const BandGrid grid(scene::SplineMap(degree, patchy.range(), patchy.coefficients()), 0);
    for (const PathTable::Lookup lookup : {PathTable::Lookup::nearest, PathTable::Lookup::bilinear}) {
      const bool bilinear = lookup == PathTable::Lookup::bilinear;
      double before = infinity;
      for (int k = 0; k < 4; ++k) {
        const PathTable table(grid.pieces(), 8 << k, lookup);
        std::mt19937_64 random(12);
        std::uniform_real_distribution<double> place(0, 64);
        double squares = 0, mean = 0, bias = 0;
        for (int i = 0; i < 800; ++i) {
          const double u = place(random), v = place(random), u1 = place(random), v1 = place(random);
          const double length = std::hypot(u1 - u, v1 - v);
          const scene::MapLine line{u, v, 0, (u1 - u) / length, (v1 - v) / length, 0};
          const scene::HeightProfile none = scene::SameAtAllHeights{};
          Visits visits;
          const double exact = grid.integral(none, line, {0, length}, nullptr, visits);
          const double error = grid.integral(none, line, {0, length}, &table, visits) - exact;
          squares += error * error;
          bias += error;
          mean += exact;
        }
        const double rms = std::sqrt(squares / 800) / (mean / 800);
        CAPTURE(degree, bilinear, 8 << k);
        if (std::getenv("AIRLIGHT_TEST_FIGURES"))
          fmt::print("degree {} {} R {}: rms {:.2e} bias {:.2e}\n", degree, bilinear ? "bilinear" : "nearest", 8 << k,
                     rms, bias / mean);
        CHECK(rms <= most[bilinear][k]);
        CHECK(rms <= before / (bilinear ? 2.8 : 1.8));
        if (bilinear) CHECK(bias > 0);
        before = rms;
      }
    }
  }
}

// The first way of such a ray is a rounding error long. Between the places of a table its length would be 0.05 cells.
TEST_CASE("wavelet fog: tables add nothing where a ray begins a rounding error before a cell", "[wavelet_fog]") {
  const BandGrid grid(map_of(1, 37, 21), 0);
  const PathTable table(grid.pieces(), 8, PathTable::Lookup::bilinear);
  const auto integral_from = [&](double v) {
    Visits visits;
    return grid.integral(scene::SameAtAllHeights{}, {4.3, v, 0, 0.6, 0.8, 0}, {0, 8}, &table, visits);
  };
  for (const int cell : {1, 2, 7}) {
    const double before = std::nextafter(double(cell), 0.0);
    CHECK(integral_from(before) == Approx(integral_from(cell)).epsilon(1e-9));
  }
}

TEST_CASE("wavelet fog: pictures of pre and of tables", "[wavelet_fog]") {
  const auto scene = scene_named("wavelet_fog/patchy", 48, 36);
  const auto rms = [](const scene::Film& a, const scene::Film& b) {
    double sum = 0;
    const auto &x = a.layer("transmittance"), &y = b.layer("transmittance");
    for (std::size_t i = 0; i < x.size(); ++i) sum += (double(x[i]) - y[i]) * (double(x[i]) - y[i]);
    return std::sqrt(sum / double(x.size()));
  };
  for (const std::string mu : {"0", "0.5", "1"}) {
    const auto pre = render(method, scene, {{"variant", "pre"}, {"mu", mu}});
    const auto paper = render(method, scene, {{"variant", "paper"}, {"mu", mu}});
    CAPTURE(mu);
    CHECK(rms(pre.film, paper.film) <= 1e-7);
    if (mu == "1") CHECK(pre.counters.at("coefficients") > 1.9 * paper.counters.at("coefficients"));
  }
  const scene::HeightProfile profiles[] = {scene::SameAtAllHeights{}, scene::Layers{{0, 3, 8}, {1, 0.8, 0}},
                                           scene::ExponentialFall{0.5, 2.5}};
  for (const scene::HeightProfile& profile : profiles) {
    auto fog = std::make_shared<scene::Fogmap>(*std::get<scene::FogmapPointer>(scene->media[0].field));
    fog->profile = profile;
    scene->media[0].field = scene::FogmapPointer(fog);
    finish(*scene);
    for (const std::string variant : {"direct", "paper", "pre"})
      for (const auto& [lookup, most] : {std::pair<std::string, double>{"nearest", 4e-3}, {"bilinear", 1.2e-3}}) {
        Given exact = {{"variant", variant}};
        if (variant != "direct") exact["mu"] = "0.7";
        Given table = exact;
        table["table"] = "16", table["lookup"] = lookup;
        const double error = rms(render(method, scene, table).film, render(method, scene, exact).film);
        CAPTURE(variant, lookup, scene::profile_name(profile));
        if (std::getenv("AIRLIGHT_TEST_FIGURES"))
          fmt::print("{} {} {}: rms {:.2e}\n", variant, lookup, scene::profile_name(profile), error);
        CHECK(error <= most);
        CHECK(error > 1e-5);
      }
  }
  // The paper's fade with the distance from the eye is an exponential too.
  auto fog = std::make_shared<scene::Fogmap>(*std::get<scene::FogmapPointer>(scene->media[0].field));
  fog->profile = scene::SameAtAllHeights{};
  scene->media[0].field = scene::FogmapPointer(fog);
  finish(*scene);
  const Given faded = {{"variant", "direct"}, {"fade", "3"}},
              by_table = {{"variant", "direct"}, {"fade", "3"}, {"table", "16"}, {"lookup", "bilinear"}};
  CHECK(rms(render(method, scene, by_table).film, render(method, scene, faded).film) <= 1.2e-3);
}

TEST_CASE("wavelet fog: tables know factors of the height that are straight along a cell", "[wavelet_fog]") {
  // Lines that rise an eighth of a cell over the ground for each cell pass from place to place of a table of R = 8, which therefore is exact,
  // whatever the layers; where a knot lies in a cell that is walked. An exponential is taken as straight: the error is of the second
  // order of its fall over a cell, zeta.
  const scene::SplineMap maps[] = {map_of(0, 30, 9), map_of(1, 30, 9), map_of(2, 30, 9)};
  double worst[2] = {0, 0};  // error over zeta^2, without and with wavelets
  const scene::Layers layers{{-1, 0.3, 2, 5}, {0.3, 1, 0.7, 0.1}};
  for (const scene::SplineMap& map : maps)
    for (const bool wavelets : {false, true}) {
      const Family& family_ = family(family_of_degree(map.degree()));
      const Decomposition d = decompose({map.range(), map.coefficients()}, family_, 1);
      const BandGrid grid = wavelets ? BandGrid(d.levels[0], family_, 0) : BandGrid(map, 0);
      const PathTable table(grid.pieces(), 8, PathTable::Lookup::nearest, true);
      for (int k = 0; k < 40; ++k) {
        const double v = k / 8.0, rise = 0.005 * (k - 20);
        const scene::MapLine line{0, v, 1 + 0.1 * k, 1, 0.125, rise};
        Visits exact, looked_up;
        const double of_layers = grid.integral(layers, line, {0, 30}, nullptr, exact);
        CAPTURE(map.degree(), wavelets, k);
        CHECK(grid.integral(layers, line, {0, 30}, &table, looked_up) == Approx(of_layers).epsilon(1e-6).margin(1e-6));
        for (const double scale : {0.4, 2.0}) {
          const scene::ExponentialFall fall{1.5, scale};
          const double zeta = std::abs(rise) / scale;
          const double of_fall = grid.integral(fall, line, {0, 30}, nullptr, exact);
          const double error = std::abs(grid.integral(fall, line, {0, 30}, &table, looked_up) - of_fall);
          if (zeta > 0.01) worst[wavelets] = std::max(worst[wavelets], error / (zeta * zeta));
        }
      }
    }
  if (std::getenv("AIRLIGHT_TEST_FIGURES"))
    fmt::print("error over zeta^2 {:.2e}, wavelets {:.2e}\n", worst[0], worst[1]);
  CHECK(worst[0] <= 2e-3);
  CHECK(worst[1] <= 0.027);
}

TEST_CASE("wavelet fog: settings that contradict each other are refused by name", "[wavelet_fog]") {
  const auto scene = scene_named("wavelet_fog/patchy", 8, 6);
  const auto refused = [&](const Given& given, const std::string& word) {
    const auto reasons = method.supports(*scene, {method.settings(), given});
    CAPTURE(word);
    CHECK(std::any_of(reasons.begin(), reasons.end(),
                      [&](const std::string& reason) { return reason.find(word) != std::string::npos; }));
  };
  refused({{"variant", "pre"}, {"coarse", "clamped"}}, "expected coarse = wavelet");
  refused({{"variant", "tele"}, {"levels", "7"}}, "levels = 7, expected at most 6");
  refused({{"variant", "polar"}, {"fade", "3"}}, "variant = polar with fade");
  refused({{"fade", "3"}}, "fade with a profile");
  const auto unread = [&](const Given& given, const std::string& message) {
    CHECK_THROWS_WITH(scene::Settings(method.settings(), given), message);
  };
  for (const std::string variant : {"pre", "paper"})
    unread(
        {{"variant", variant}, {"termination", "0.1"}},
        "settings: termination = 0.1 is not read with variant = " + variant +
            " and sun = false, expected variant = skip or bound or polar, or sun = true and variant = tele or direct");
  unread(
      {{"variant", "tele"}, {"termination", "0.1"}},
      "settings: termination = 0.1 is not read with variant = tele and sun = false, expected variant = skip or bound or "
      "polar, or sun = true");
  unread({{"variant", "skip"}, {"table", "8"}},
         "settings: table = 8 is not read with variant = skip, expected variant = direct or pre or paper");
  const std::pair<const char*, const char*> out_of_range[] = {
      {"mu", "1.01"}, {"mu", "-0.01"}, {"mu", "nan"},        {"table", "65"},   {"levels", "-1"},
      {"fade", "-1"}, {"angles", "7"}, {"tolerance", "inf"}, {"sun_step", "0"}, {"termination", "1"}};
  for (const auto& [name, value] : out_of_range)
    CHECK_THROWS_WITH(scene::Settings(method.settings(), {{name, value}}), Catch::Contains(name));
}

}  // namespace band_grid_test
