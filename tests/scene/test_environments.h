// Environments for tests: maps of a few texels, and spherical harmonics.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <random>

#include "scene/light/environment.h"

namespace airlight::test {

using scene::EnvironmentLight;
using scene::EnvironmentMap;

inline const Mat3 tilted = Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();

inline std::shared_ptr<EnvironmentMap> make_map(int width, int height, float value = 0) {
  auto map = std::make_shared<EnvironmentMap>();
  map->width = width;
  map->height = height;
  map->rgb.assign(3 * std::size_t(width) * height, value);
  return map;
}

inline void set(EnvironmentMap& map, int column, int row, float value) {
  for (int c = 0; c < 3; ++c) map.rgb[3 * (std::size_t(row) * map.width + column) + c] = value;
}

// Noise with a third of it black, and one lamp: neighbours of both kinds.
inline std::shared_ptr<EnvironmentMap> rough_map() {
  auto map = make_map(16, 8);
  std::mt19937 random(11);
  for (float& v : map->rgb) v = std::max(0.0f, std::uniform_real_distribution<float>(-1, 2)(random));
  set(*map, 5, 2, 50);
  return map;
}

inline EnvironmentLight map_light(std::shared_ptr<const EnvironmentMap> map, const Mat3& to_map = Mat3::Identity()) {
  return scene::make_map_environment(std::move(map), to_map, Rgb::Ones(), "test");
}

inline EnvironmentLight sh_light(const Mat3& to_map = Mat3::Identity()) {
  std::vector<Rgb> coefficients(16, Rgb::Zero());
  std::mt19937 random(12);
  for (Rgb& c : coefficients)
    for (int k = 0; k < 3; ++k) c[k] = std::normal_distribution<double>()(random);
  return scene::make_sh_environment(coefficients, to_map, Rgb(1, 0.5, 2));
}

}  // namespace airlight::test
