// Environments as spherical harmonics.
#include <catch2/catch.hpp>

#include "scene/light/lat_long.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"
#include "tests/scene/test_environments.h"

namespace environment_projection_test {

using namespace airlight;
using namespace airlight::scene;
using namespace airlight::test;

// A constant has only c_00 = sqrt(4 pi); coefficients come back from their own function, turned or not; a map that is a
// clamped cosine about y has bands pi, 2 pi/3 and pi/4 of the convolution theorem (Ramamoorthi and Hanrahan 2001).
TEST_CASE("environments are projected on spherical harmonics", "[environment]") {
  const auto constant = project_environment(map_light(make_map(5, 3, 2.0f)), 4);
  REQUIRE(constant.size() == 16);
  CHECK(constant[0][1] == Approx(2 * std::sqrt(4 * pi)).epsilon(1e-10));
  for (int i = 1; i < 16; ++i) CHECK(std::abs(constant[i][1]) < 1e-9);
  CHECK(project_environment(make_constant_environment(Rgb(1, 2, 3)), 2)[0][2] == Approx(3 * std::sqrt(4 * pi)));

  const EnvironmentLight light = sh_light(), rotated = sh_light(tilted);
  const auto same = project_environment(light, 4);
  for (int i = 0; i < 16; ++i) CHECK(same[i].isApprox(light.scale * light.sh[i], 1e-14));
  const auto shorter = project_environment(rotated, 3), longer = project_environment(rotated, 6);
  REQUIRE(longer.size() == 36);
  for (int i = 0; i < 9; ++i) CHECK((shorter[i] - longer[i]).abs().maxCoeff() < 1e-13);
  for (int i = 16; i < 36; ++i) CHECK(longer[i].abs().maxCoeff() < 1e-13);
  std::mt19937 random(13);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3 w = Vec3::Random().normalized();
    CHECK((evaluate_sh(longer, w) - radiance(rotated, w)).abs().maxCoeff() < 1e-12);
  }

  // Interpolation between rows pi/256 apart errs by h^2/8 = 2e-5 of the second derivative.
  auto cosine = make_map(8, 256);
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 8; ++i) set(*cosine, i, j, float(std::max(0.0, std::cos(pi * (j + 0.5) / 256))));
  // Zonal about y: c_lm = A_l Y_lm(y), A = pi, 2 pi/3, pi/4 (bands 0 to 2), 0 (band 3).
  const auto projected = project_environment(map_light(cosine), 4);
  const auto axis = evaluate_sh(4, Vec3::UnitY());
  const double bands[] = {pi, 2 * pi / 3, pi / 4, 0};
  for (int l = 0; l < 4; ++l)
    for (int m = -l; m <= l; ++m)
      CHECK(projected[sh_index(l, m)][0] == Approx(bands[l] * axis[sh_index(l, m)]).margin(1e-4));
}

// Gauss points in every stretch between texel centres: the bilinear map's radiance times the harmonics.
std::vector<Rgb> by_gauss_points(const EnvironmentLight& light, int order) {
  const EnvironmentMap& map = *light.map;
  const auto points = [&](double angle) { return std::min(8 + int(3 * order * angle), 64); };
  const GaussLegendre across = gauss_legendre(points(2 * pi / map.width)),
                      down = gauss_legendre(points(pi / map.height));
  std::vector<Rgb> sum(std::size_t(order * order), Rgb::Zero());
  for (int strip = 0; strip <= map.height; ++strip) {
    const double begin = strip_begin(strip, map.height), end = strip_begin(strip + 1, map.height);
    for (std::size_t j = 0; j < down.node.size(); ++j) {
      const double theta = begin + (end - begin) * 0.5 * (1 + down.node[j]);
      for (int left = 0; left < map.width; ++left)
        for (std::size_t i = 0; i < across.node.size(); ++i) {
          const double u = (left + 0.5 + 0.5 * (1 + across.node[i])) / map.width;
          const Vec3 w = light.to_map.transpose() * from_lat_long(u, std::cos(theta), std::sin(theta));
          const double weight =
              across.weight[i] * down.weight[j] * 0.5 * (end - begin) * std::sin(theta) * pi / map.width;
          const std::vector<double> basis = evaluate_sh(order, w);
          for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * basis[k] * radiance(light, w);
        }
    }
  }
  return sum;
}

TEST_CASE("a map's projection is the integral over its stretches", "[environment]") {
  std::mt19937 random(14);
  for (const int order : {1, 2, 6, 9})
    for (const auto& [width, height] : {std::pair(1, 1), {1, 4}, {6, 1}, {5, 3}, {16, 9}}) {
      CAPTURE(order, width, height);
      auto map = make_map(width, height);
      for (float& value : map->rgb) value = std::uniform_real_distribution<float>(0, 2)(random);
      const EnvironmentLight light = map_light(map, tilted);
      const auto projected = project_environment(light, order), expected = by_gauss_points(light, order);
      for (std::size_t k = 0; k < expected.size(); ++k)
        CHECK((projected[k] - expected[k]).abs().maxCoeff() < 1e-11 * expected[0].maxCoeff());
    }
}

}  // namespace environment_projection_test
