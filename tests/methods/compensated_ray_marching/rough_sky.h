// Environments for tests: a map of coloured texels, brighter on one side and turned about a slanting axis; two bands of harmonics.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "scene/light/environment.h"

namespace airlight::test {

inline std::shared_ptr<const scene::EnvironmentMap> rough_map(int width, int height, double seed = 1) {
  auto map = std::make_shared<scene::EnvironmentMap>(scene::EnvironmentMap{width, height, {}});
  for (int i = 0; i < 3 * width * height; ++i) {
    const double longitude = 2 * pi * (i / 3 % width) / width;
    map->rgb.push_back(float(std::exp(2 * std::sin(seed + 0.7 * i) + 2 * std::sin(longitude + seed * (i % 3)))));
  }
  return map;
}

inline scene::EnvironmentLight rough_sky(double turn, std::shared_ptr<const scene::EnvironmentMap> map) {
  return make_map_environment(std::move(map), Eigen::AngleAxisd(turn, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
                              Rgb(0.3, 0.5, 0.4), "");
}

// Radiance 1 + 0.8 cos towards +y in the red, from the side in the other channels; turned about a slanting axis.
inline scene::EnvironmentLight uneven(double turn = 0) {
  const double one = std::sqrt(4 * pi), slope = std::sqrt(4 * pi / 3);
  const Mat3 rotation = Eigen::AngleAxisd(turn, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  return scene::make_sh_environment(
      {Rgb::Constant(one), Rgb(-0.8 * slope, 0, 0.2), Rgb(0, 0.5, 0), Rgb(0, -0.5 * slope, 0.4)}, rotation,
      Rgb::Ones());
}

}  // namespace airlight::test
