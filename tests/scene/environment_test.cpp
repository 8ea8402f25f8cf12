#include "scene/light/environment.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "experiments/judging/statistics.h"
#include "scene/base/error.h"
#include "scene/film/film.h"
#include "scene/light/lat_long.h"
#include "scene/math/spherical_harmonics.h"
#include "tests/scene/test_environments.h"
#include "tests/temporary_folder.h"

namespace environment_test {

using namespace airlight;
using namespace airlight::scene;
using namespace airlight::test;

namespace {

std::vector<EnvironmentLight> all_lights() {
  auto lamp = make_map(64, 32);  // black but for one texel, the hardest for a table
  set(*lamp, 0, 7, 1e9f);
  return {make_constant_environment(Rgb(1, 2, 3)),
          map_light(rough_map()),
          map_light(rough_map(), tilted),
          map_light(lamp),
          map_light(make_map(8, 4)),
          map_light(make_map(1, 1, 2.0f)),
          sh_light(),
          sh_light(tilted)};
}

// Midpoint rule over the sphere with equal cells in (height, longitude).
template <class F>
auto integrate(int n, F f) {
  std::decay_t<decltype(f(Vec3()))> sum = 0 * f(Vec3::UnitY());
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const double y = 1 - 2 * (j + 0.5) / n;
      sum += f(from_lat_long((i + 0.5) / (2 * n), y, std::sqrt(1 - y * y)));
    }
  return decltype(sum)(sum * 4 * pi / (2.0 * n * n));
}

}  // namespace

// Row 0 is +y, the centre of the picture -z, its right half +x; the seam lies along +z.
TEST_CASE("an environment map is the right way round", "[environment]") {
  const int width = 8, height = 4;
  const auto brightest_texel = [&](const Vec3& w) {
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        auto map = make_map(width, height);
        set(*map, i, j, 1);
        if (radiance(map_light(map), w)[0] > 0.999) return std::pair(i, j);
      }
    return std::pair(-1, -1);
  };
  // Centres of texels: longitude (i + 0.5) 45 degrees from the left border, polar angle (j + 0.5) 45 degrees.
  const double a = pi / 8;
  CHECK(brightest_texel({0, 1, 0}) == std::pair(-1, -1));  // the pole lies between all texels of the top row
  const auto at = [&](double polar, double right) {        // `right`: angle from -z towards +x
    return Vec3(std::sin(polar) * std::sin(right), std::cos(polar), -std::sin(polar) * std::cos(right));
  };
  CHECK(brightest_texel(at(a, a)) == std::pair(4, 0));
  CHECK(brightest_texel(at(a, -a)) == std::pair(3, 0));
  CHECK(brightest_texel(at(3 * a, 5 * a)) == std::pair(6, 1));  // near +x
  CHECK(brightest_texel(at(3 * a, -5 * a)) == std::pair(1, 1));
  CHECK(brightest_texel(at(7 * a, 7 * a)) == std::pair(7, 3));   // near +z, from the right
  CHECK(brightest_texel(at(7 * a, -7 * a)) == std::pair(0, 3));  // near +z, from the left

  // The whole top row is seen at the pole; across the seam the two border columns are mixed.
  auto map = make_map(width, height);
  for (int i = 0; i < width; ++i) set(*map, i, 0, 3);
  CHECK(radiance(map_light(map), Vec3::UnitY())[0] == Approx(3));
  CHECK(radiance(map_light(map), -Vec3::UnitY())[0] == 0);
  CHECK(radiance(map_light(map), Vec3::UnitX())[0] == 0);  // halfway between rows 1 and 2
  map = make_map(width, height);
  for (int j = 0; j < height; ++j) set(*map, 0, j, 1), set(*map, width - 1, j, 2);
  CHECK(radiance(map_light(map), Vec3::UnitZ())[0] == Approx(1.5));
  CHECK(radiance(map_light(map), -Vec3::UnitZ())[0] == 0);

  // to_map takes a world direction to the map's: a map looked at through a turn of the world.
  CHECK((radiance(map_light(rough_map(), tilted), Vec3::UnitX()) - radiance(map_light(rough_map()), tilted.col(0)))
            .abs()
            .maxCoeff() < 1e-6);
}

// The density is piecewise smooth: the midpoint rule with 2 n^2 cells errs by O(n^-2), a few 1e-5 for n = 800; the lamp
// (a tent two texels wide, 50 cells across) by O((n/32)^-2).
TEST_CASE("densities of environments integrate to 1 and are positive", "[environment]") {
  for (const EnvironmentLight& light : all_lights()) {
    CAPTURE(light.source, light.sh.size(), light.map ? light.map->width : 0);
    double least = infinity;
    const double sum = integrate(800, [&](const Vec3& w) {
      const double pdf = pdf_environment(light, w);
      least = std::min(least, pdf);
      return pdf;
    });
    CHECK(sum == Approx(1).epsilon(3e-4));
    CHECK(least >= 0.05 / (4 * pi) * (1 - 1e-12));
  }
}

TEST_CASE("radiance and density come together as they come apart", "[environment]") {
  for (const EnvironmentLight& light : all_lights()) {
    int differing = 0;
    integrate(30, [&](const Vec3& w) {
      const EnvironmentValue both = evaluate_environment(light, w);
      differing += !(both.pdf == pdf_environment(light, w) && (both.radiance == radiance(light, w)).all());
      return 0.0;
    });
    CHECK(differing == 0);
  }
}

// Chi-square over 32 x 16 bins equal in solid angle; expected counts by quadrature of the density, 40 x 40 points in
// each bin. False-alarm rate 1e-6 for each of the 8 lights; fixed seed.
TEST_CASE("environments are sampled as their densities say", "[environment]") {
  const int rows = 16, columns = 32, samples = 200000, fine = 40;
  for (const EnvironmentLight& light : all_lights()) {
    CAPTURE(light.source, light.sh.size(), light.map ? light.map->width : 0);
    std::vector<double> expected(rows * columns, 0.0), seen(rows * columns, 0.0);
    for (int j = 0; j < rows * fine; ++j)
      for (int i = 0; i < columns * fine; ++i) {
        const double y = 1 - 2 * (j + 0.5) / (rows * fine);
        const Vec3 w = from_lat_long((i + 0.5) / (columns * fine), y, std::sqrt(1 - y * y));
        expected[j / fine * columns + i / fine] +=
            pdf_environment(light, w) * 4 * pi * samples / (double(rows) * columns * fine * fine);
      }
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform;
    for (int k = 0; k < samples; ++k) {
      const double u1 = uniform(random);
      const Vec3 w = sample_environment(light, u1, uniform(random));
      REQUIRE(std::abs(w.norm() - 1) < 1e-12);
      const int row = std::min(rows - 1, int((1 - w[1]) / 2 * rows));
      const int column = std::min(columns - 1, int(to_lat_long(w).u * columns));
      ++seen[row * columns + column];
    }
    double chi = 0;
    int bins = 0;
    for (int b = 0; b < rows * columns; ++b) {
      REQUIRE(expected[b] > 5);  // the uniform 5 % alone gives 19
      chi += (seen[b] - expected[b]) * (seen[b] - expected[b]) / expected[b];
      ++bins;
    }
    CAPTURE(chi, bins);
    CHECK(experiments::chi_square_above(chi, bins - 1) > 1e-6);
  }
}

// Irradiance of a plane that faces n: Monte Carlo over the light's own samples against quadrature, z < 5.3 in 8 x 3
// tests (false-alarm rate 3e-6 all together, two-sided, Sidak).
TEST_CASE("irradiance by sampling is irradiance by quadrature", "[environment]") {
  for (const EnvironmentLight& light : all_lights()) {
    CAPTURE(light.source, light.sh.size(), light.map ? light.map->width : 0);
    const Vec3 n = Vec3(0.2, 0.9, -0.4).normalized();
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> uniform;
    const int samples = 100000;
    Rgb sum = Rgb::Zero(), squares = Rgb::Zero();
    for (int k = 0; k < samples; ++k) {
      const double u1 = uniform(random);
      const Vec3 w = sample_environment(light, u1, uniform(random));
      const Rgb value = radiance(light, w) * std::max(0.0, n.dot(w)) / pdf_environment(light, w);
      REQUIRE(value.allFinite());
      sum += value;
      squares += value * value;
    }
    const Rgb irradiance =
        integrate(800, [&](const Vec3& w) -> Rgb { return radiance(light, w) * std::max(0.0, n.dot(w)); });
    for (int c = 0; c < 3; ++c) {
      const double expected = irradiance[c];
      const double mean = sum[c] / samples;
      const double error = std::sqrt(std::max(0.0, squares[c] / samples - mean * mean) / samples);
      CAPTURE(mean, expected, error);
      CHECK(std::abs(mean - expected) <= 5.3 * error + 3e-4 * std::abs(expected));
    }
  }
}

// The density follows the bilinear map: luminance over density is nearly the power, whatever the map. In the strips
// that touch the polar caps it may differ by the ratio of angle to cosine (below 2), and the 5 % uniform take their
// share.
TEST_CASE("no sample of an environment is a firefly", "[environment]") {
  for (const EnvironmentLight& light : all_lights()) {
    if (!light.map) continue;
    const double power = environment_power(light);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform;
    double largest = 0;
    for (int k = 0; k < 100000; ++k) {
      const double u1 = uniform(random);
      const Vec3 w = sample_environment(light, u1, uniform(random));
      largest = std::max(largest, luminance(radiance(light, w)) / pdf_environment(light, w));
    }
    CHECK(largest <= 2.2 * power);
  }
}

TEST_CASE("the power of an environment is the integral of its luminance", "[environment]") {
  for (const EnvironmentLight& light : all_lights()) {
    CAPTURE(light.source, light.sh.size(), light.map ? light.map->width : 0);
    const double expected = integrate(800, [&](const Vec3& w) { return luminance(radiance(light, w)); });
    CHECK(environment_power(light) == Approx(expected).epsilon(3e-4).margin(1e-9));
  }
  // Closed forms: a constant c has 4 pi c.
  CHECK(environment_power(make_constant_environment(Rgb(1, 1, 1))) == Approx(4 * pi));
  CHECK(environment_power(map_light(make_map(7, 3, 0.5f))) == Approx(2 * pi).epsilon(1e-14));
}

TEST_CASE("a black environment is black, and nothing is NaN", "[environment]") {
  const EnvironmentLight light = map_light(make_map(8, 4));
  CHECK(environment_power(light) == 0);
  for (const double u1 : {0.0, 0.03, 0.5, std::nextafter(1.0, 0.0)})
    for (const double u2 : {0.0, 0.7, std::nextafter(1.0, 0.0)}) {
      const Vec3 w = sample_environment(light, u1, u2);
      CHECK(w.allFinite());
      CHECK(pdf_environment(light, w) == Approx(1 / (4 * pi)));
      CHECK((radiance(light, w) == 0).all());
    }
}

TEST_CASE("extreme uniforms and directions give finite answers", "[environment]") {
  for (const EnvironmentLight& light : all_lights()) {
    for (const double u1 : {0.0, 0.05, std::nextafter(0.05, 0.0), std::nextafter(1.0, 0.0), 1.0})
      for (const double u2 : {0.0, 0.5, std::nextafter(1.0, 0.0), 1.0}) {
        const Vec3 w = sample_environment(light, u1, u2);
        CHECK(std::abs(w.norm() - 1) < 1e-12);
        CHECK(std::isfinite(pdf_environment(light, w)));
        CHECK(radiance(light, w).allFinite());
      }
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const Vec3 w = sign * Vec3::Unit(axis);
        CHECK(radiance(light, w).allFinite());
        CHECK(pdf_environment(light, w) > 0);
      }
  }
}

// Y_10 is negative on half of the sphere; with c_00 = 1 and c_10 = b, where 1 + sqrt(3) b z < 0: for b = 1 a share of
// (1 - 1/sqrt(3)) / 2.
TEST_CASE("negative lobes keep their sign and are reported", "[environment]") {
  std::vector<Rgb> sh(4, Rgb::Zero());
  sh[0] = sh[2] = Rgb::Ones();
  const EnvironmentLight light = make_sh_environment(sh, Mat3::Identity(), Rgb::Ones());
  CHECK(radiance(light, -Vec3::UnitZ())[0] == Approx((1 - std::sqrt(3.0)) / std::sqrt(4 * pi)));
  CHECK(negative_fraction(light) == Approx((1 - 1 / std::sqrt(3.0)) / 2).margin(2e-3));
  CHECK(environment_power(light) == Approx(std::sqrt(4 * pi)));
  CHECK(negative_fraction(make_constant_environment(Rgb::Ones())) == 0);
}

TEST_CASE("what is no environment is refused", "[environment]") {
  CHECK_THROWS_AS(make_constant_environment(Rgb(1, -1, 1)), Error);
  CHECK_THROWS_AS(make_constant_environment(Rgb(1, std::nan(""), 1)), Error);
  CHECK_THROWS_AS(make_sh_environment(std::vector<Rgb>(5, Rgb::Zero()), Mat3::Identity(), Rgb::Ones()), Error);
  CHECK_THROWS_AS(make_sh_environment({}, Mat3::Identity(), Rgb::Ones()), Error);
  CHECK_THROWS_AS(map_light(rough_map(), 2 * Mat3::Identity()), Error);
  CHECK_THROWS_AS(map_light(rough_map(), Vec3(1, 1, -1).asDiagonal()), Error);
  CHECK_THROWS_AS(map_light(nullptr), Error);

  const TemporaryFolder folder;
  const std::string path = folder.file("map.exr");
  Film film(4, 2);
  film.add("mean");
  for (const double bad : {-1.0, infinity, std::nan("")}) {
    film.set("mean", 3, 1, Rgb(0, bad, 0));
    write_exr(path, film, true);
    CHECK_THROWS_WITH(read_environment_map(path), Catch::Contains(path + ": texel (3, 1) holds "));
  }
  film = Film(4, 2);
  for (int x = 0; x < 4; ++x) film.set("mean", x, 0, Rgb::Constant(2));  // mean 1
  film.set("mean", 3, 1, Rgb(0, -0.0099, 0));
  write_exr(path, film);
  CHECK(read_environment_map(path)->rgb[22] == 0);
  film.set("mean", 3, 1, Rgb(0, -0.0101, 0));
  write_exr(path, film);
  CHECK_THROWS_WITH(read_environment_map(path), Catch::Contains("texel (3, 1) holds -0.0101"));
  film.layers.clear();
  film.add("airlight");
  write_exr(path, film);
  CHECK_THROWS_WITH(read_environment_map(path), Catch::Contains("no layer 'mean'"));
}

// Peak and mean luminance of the shipped maps as measured by another program when they were chosen, to the digits given
// (the mean over texels with the weight sin(theta) of their centres); and the sampler at work on them.
TEST_CASE("the maps of the experiments are read right", "[environment]") {
  const std::string folder = AIRLIGHT_SOURCE_DIR "/experiments/data/";
  struct Expected {
    const char* file;
    double peak, peak_tolerance, mean;
  };
  for (const Expected& e : {Expected{"courtyard.exr", 55.6, 0.05, 0.7663}, Expected{"interior.exr", 33952, 0.5, 1.0503},
                            Expected{"sunrise.exr", 33664, 0.5, 0.6980}}) {
    CAPTURE(e.file);
    const auto map = read_environment_map(folder + e.file);
    CHECK(map->width == 1024);
    CHECK(map->height == 512);
    double peak = 0, sum = 0, weights = 0;
    for (int j = 0; j < map->height; ++j)
      for (int i = 0; i < map->width; ++i) {
        const float* t = &map->rgb[3 * (std::size_t(j) * map->width + i)];
        const double weight = std::sin(pi * (j + 0.5) / map->height);
        for (int c = 0; c < 3; ++c) peak = std::max(peak, double(t[c]));
        sum += weight * luminance(Rgb(t[0], t[1], t[2]));
        weights += weight;
      }
    CHECK(std::abs(peak - e.peak) <= e.peak_tolerance);
    CHECK(std::abs(sum / weights - e.mean) <= 5e-5);

    const EnvironmentLight light = make_map_environment(map, tilted, Rgb::Ones(), e.file);
    // The bilinear map spreads a texel over its neighbours: the same mean but for the change of sin(theta) over it.
    CHECK(environment_power(light) == Approx(4 * pi * e.mean).epsilon(1e-3));
    // c_00 = integral / sqrt(4 pi), by another quadrature.
    const auto sh = project_environment(light, 3);
    CHECK(luminance(sh[0]) == Approx(environment_power(light) / std::sqrt(4 * pi)).epsilon(1e-8));
    // Samples of the luminance have next to no variance: 2e-3 with 10 000 stratified ones, also for the sun.
    double estimate = 0;
    const int n = 100;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 w = sample_environment(light, (j + 0.5) / n, (i + 0.5) / n);
        estimate += luminance(radiance(light, w)) / pdf_environment(light, w) / (n * n);
      }
    CHECK(estimate == Approx(environment_power(light)).epsilon(2e-3));
  }
}

}  // namespace environment_test
