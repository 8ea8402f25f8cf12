// Environments in harmonics: a map is projected once, and its turned bands are those of the turned map.
#include "methods/compensated_ray_marching/environment_bands.h"

#include <catch2/catch.hpp>

#include "methods/compensated_ray_marching/incoming_light.h"
#include "scene/math/spherical_harmonics.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"

namespace environment_bands_test {

using namespace airlight;
using namespace airlight::test;
using compensated_ray_marching::EnvironmentBands;

namespace {

// Environment bands that count projections.
EnvironmentBands counted(int order, int& count) {
  return {order, [order, &count](const std::shared_ptr<const scene::EnvironmentMap>& map) {
            ++count;
            return project_environment(rough_sky(0, map), order);
          }};
}

double greatest(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).abs().maxCoeff());
  return most;
}

}  // namespace

TEST_CASE("environments in bands: turned bands are those of the turned map", "[compensated_ray_marching]") {
  // An exact rule between texels: bands turn with their nodes, so that rounding alone is left.
  const auto map = rough_map(16, 8);
  for (const int order : {1, 4, 8, 20}) {
    EnvironmentBands bands(order);
    for (const double turn : {0.0, 0.3, 2.0, pi}) {
      CAPTURE(order, turn);
      const auto exact = project_environment(rough_sky(turn, map), order);
      CHECK(greatest(bands.of({rough_sky(turn, map)}), exact) < 1e-13 * order * exact[0].maxCoeff());
    }
  }
}

TEST_CASE("environments in bands: together, and of other kinds", "[compensated_ray_marching]") {
  EnvironmentBands bands(3);
  const scene::EnvironmentLight sky = rough_sky(1, rough_map(5, 3)),
                                even = scene::make_constant_environment(Rgb(1, 2, 3)),
                                slope = scene::make_sh_environment(std::vector<Rgb>(16, Rgb(0.1, 0.2, 0.3)), sky.to_map,
                                                                   Rgb(1, 2, 1));
  std::vector<Rgb> sum = project_environment(sky, 3);
  for (const auto& light : {even, slope}) {
    const auto one = project_environment(light, 3);
    for (std::size_t i = 0; i < 9; ++i) sum[i] += one[i];
  }
  CHECK(greatest(bands.of({sky, even, slope}), sum) < 1e-12);
  CHECK(greatest(bands.of({}), std::vector<Rgb>(9, Rgb::Zero())) == 0);
}

TEST_CASE("environments in bands: a map is projected once, by content, and forgotten after eight others",
          "[compensated_ray_marching]") {
  int count = 0;
  EnvironmentBands bands = counted(4, count);
  const auto map = rough_map(8, 4);
  for (const double turn : {0.0, 1.0, 2.0}) bands.of({rough_sky(turn, map), rough_sky(-turn, rough_map(8, 4))});
  CHECK(count == 1);
  for (int i = 1; i < 8; ++i) bands.of({rough_sky(0, rough_map(8, 4, 1 + i))});
  bands.of({rough_sky(0.5, map)});
  CHECK(count == 8);
  bands.of({rough_sky(0.5, rough_map(8, 4, 9))});
  bands.of({rough_sky(0.5, map)});
  CHECK(count == 10);
}

TEST_CASE("light from fixed directions is the turned map's, in bands, of a map that is projected once",
          "[compensated_ray_marching]") {
  int count = 0;
  const auto map = rough_map(16, 8);
  compensated_ray_marching::IncomingLight light({rough_sky(0, map)}, counted(8, count));
  // The counting projection has the scale in it.
  const Rgb scale = rough_sky(0, map).scale;
  for (const double turn : {0.4, 2.5}) {
    light.become({rough_sky(turn, map)});
    const auto bands = project_environment(rough_sky(turn, map), 8);
    for (std::size_t k = 0; k < light.fixed(); ++k) {
      const Rgb radiance = scene::evaluate_sh(bands, light.directions()[k]);
      const double weight = compensated_ray_marching::ordinate_directions(8, 16, false)[k].weight;
      REQUIRE((light.power()[k] - weight * scale * radiance).abs().maxCoeff() < 1e-12);
    }
  }
  CHECK(count == 1);
}

}  // namespace environment_bands_test
