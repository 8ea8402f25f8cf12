// The rows of light of the table of extremes (corrected mathematics, section 12), for both backends.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "scene/media/legendre_box.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace airlight::legendre_fluids::testing {

struct ExtremeLight {
  std::string row;
  std::shared_ptr<scene::Scene> scene;
  double depth;  // mean optical depth along a side of the box, of a density that is 1 on average
};

inline scene::LegendrePointer series(const scene::TensorShape& n, const std::map<int, double>& coefficients) {
  Eigen::VectorXd c = Eigen::VectorXd::Zero(scene::tensor_size(n));
  for (const auto& [at, value] : coefficients) c[at] = value;
  return std::make_shared<const scene::LegendreBox>(unit_box, n, c);
}

inline std::vector<ExtremeLight> extreme_lights() {
  constexpr int width = 9, height = 7;
  const auto with = [&](scene::LegendrePointer field, double depth, const Vec3& light = oblique_light) {
    auto scene = lit_scene(smoke(std::move(field), 0.5 * depth), light, oblique_view, width, height);
    scene->camera.position *= 0.6;  // the device takes extinction times coordinates of 3e4: single precision
    return scene;
  };
  std::vector<ExtremeLight> all{{"zero density", with(series({2, 2, 2}, {}), 1), 1}};
  for (const double depth : {1e-6, 1e-3, 100.0, 1e3, 1e4})
    all.push_back({"optical depth", with(random_density({4, 4, 4}, 3), depth), depth});
  all.push_back({"r < 0 in places", with(series({2, 2, 2}, {{0, 1}, {7, 2}}), 2), 2});
  all.push_back({"r < 0 everywhere", with(series({2, 2, 2}, {{0, -1}}), 2), 2});
  for (const Vec3& light : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, 1e-6, 0), Vec3(1e-6, 1, -1e-9)})
    all.push_back({"light along an axis, grazing", with(random_density({4, 4, 4}, 3), 2, light), 2});
  all.push_back({"n = 1", with(random_density({1, 1, 1}, 1), 2), 2});
  all.push_back({"n = 32", with(random_density({32, 2, 1}, 1), 2), 2});
  return all;
}

// Checks a picture by rays: values are finite, not below 0, and at most the light that single scattering can send, up
// to rounding of a film. The bound is the ray's absorption 1 - exp(-depth), times 0.8 / (4 pi): irradiance 1 and albedo
// 0.8, equal in all directions.
inline void check_light(const ExtremeLight& given, const scene::Film& film) {
  CAPTURE(given.row, given.depth);
  const auto& airlight = film.layer("airlight");
  const auto& transmittance = film.layer("transmittance");
  for (const auto& [layer, values] : film.layers)
    for (const float v : values) REQUIRE(std::isfinite(v));
  bool any = false;
  for (std::size_t i = 0; i < airlight.size(); ++i) {
    CHECK(airlight[i] >= 0);
    CHECK(transmittance[i] >= 0);
    CHECK(transmittance[i] <= 1);
    CHECK(airlight[i] <= 0.8 / (4 * pi) * (1 - double(transmittance[i])) * (1 + 1e-5) + 1e-7);
    any |= airlight[i] > 0;
  }
  CHECK(any == (given.row != "zero density" && given.row != "r < 0 everywhere"));
  if (any) return;
  for (const float v : airlight) CHECK(v == 0);
  for (const float v : transmittance) CHECK(v == 1);
}

// Checks a picture by the paper's systems, whose error can be as large as all of the light: values are finite, clamped
// at 0, and 0 without density.
inline void check_paper_light(const ExtremeLight& given, const scene::Film& film) {
  CAPTURE(given.row, given.depth);
  for (const auto& [layer, values] : film.layers)
    for (const float v : values) {
      REQUIRE(std::isfinite(v));
      CHECK(v >= 0);
      if (given.row == "zero density") CHECK(v == 0);
    }
}

}  // namespace airlight::legendre_fluids::testing
