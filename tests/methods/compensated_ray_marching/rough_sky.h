// A coloured map of light and dark texels, brighter on one side, turned about an axis that is none of the world's.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "scene/environment.h"

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

}  // namespace airlight::test
