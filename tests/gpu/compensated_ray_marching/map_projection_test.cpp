// Maps projected on harmonics by the device: against the processor, and in closed form.
#include "gpu/compensated_ray_marching/map_projection.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/math/spherical_harmonics.h"
#include "tests/gpu/device.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"

namespace map_projection_test {

using namespace airlight;
using namespace airlight::test;
using gpu::Buffer;
using gpu::compensated_ray_marching::MapProjection;

namespace {

std::vector<Rgb> on_device(MapProjection& projection, const scene::EnvironmentMap& map) {
  return projection.of(map, Buffer(gpu::Context::get(), "texels", map.rgb));
}
std::vector<Rgb> on_processor(const std::shared_ptr<const scene::EnvironmentMap>& map, int order) {
  scene::EnvironmentLight light;
  light.map = map;
  return project_environment(light, order);
}
double difference(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).abs().maxCoeff());
  return most;
}

}  // namespace

DEVICE_TEST_CASE("maps are projected on the device as on the processor", "[gpu][compensated_ray_marching][thorough]") {
  const gpu::Use use(context);
  for (const int order : {1, 2, 4, 6, 8, 12, 32}) {
    MapProjection projection(context, order);
    for (const auto& [width, height] : {std::pair(1, 1), {1, 5}, {7, 1}, {5, 3}, {64, 32}, {65, 130}, {257, 64}}) {
      CAPTURE(order, width, height);
      const auto map = rough_map(width, height);
      const auto processor = on_processor(map, order);
      CHECK(difference(on_device(projection, *map), processor) < 1e-12 * processor[0].maxCoeff());
    }
  }
}

DEVICE_TEST_CASE("maps of as many texels as real ones are projected on the device to twelve digits",
                 "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  MapProjection projection(context, 6);
  const auto map = rough_map(1024, 512);
  const auto processor = on_processor(map, 6);
  CHECK(difference(on_device(projection, *map), processor) < 1e-12 * processor[0].maxCoeff());
}

DEVICE_TEST_CASE("even maps and single columns on the device, in closed form", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const int order = 8;
  MapProjection projection(context, order);
  const auto even = on_device(projection, {9, 6, std::vector<float>(3 * 9 * 6, 2.0F)});
  std::vector<Rgb> constant(std::size_t(order * order), Rgb::Zero());
  constant[0] = Rgb::Constant(2 * std::sqrt(4 * pi));
  CHECK(difference(even, constant) < 1e-12);
  // One column of a map: a hat over longitude, which band 0 sees as two texels' half, and band 1 as sinc^2 of half a texel, towards it.
  scene::EnvironmentMap column{12, 6, std::vector<float>(3 * 12 * 6, 0.0F)};
  for (int row = 0; row < 6; ++row)
    for (int c = 0; c < 3; ++c) column.rgb[std::size_t(3 * (row * 12 + 8) + c)] = 1;
  const auto lit = on_device(projection, column);
  const double spacing = 2 * pi / 12, longitude = spacing * 8.5 - pi, shrunk = std::sin(spacing / 2) / (spacing / 2);
  CHECK(std::abs(lit[0][0] - 2 * spacing / std::sqrt(4 * pi)) < 1e-12);
  // The integral of sin^2 over the angle from the pole is pi / 2.
  const double length = std::sqrt(3 / (4 * pi)) * spacing * shrunk * shrunk * pi / 2;
  CHECK(std::abs(lit[3][0] + length * std::sin(longitude)) < 1e-12);
  CHECK(std::abs(lit[2][0] + length * std::cos(longitude)) < 1e-12);
  CHECK(std::abs(lit[1][0]) < 1e-12);
}

}  // namespace map_projection_test
