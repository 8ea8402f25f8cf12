// A coloured sky of 128 x 64 texels: the courtyard's, each the mean of 8 x 8. Its projection takes a 64th of the time.
#pragma once
#include <memory>

#include "scene/light/environment.h"

namespace airlight::gpu::test {

inline std::shared_ptr<const scene::EnvironmentMap> small_courtyard() {
  constexpr int by = 8;
  const auto large = scene::read_environment_map(AIRLIGHT_SOURCE_DIR "/experiments/data/courtyard.exr");
  scene::EnvironmentMap map{large->width / by, large->height / by, {}};
  map.rgb.assign(std::size_t(3) * map.width * map.height, 0);
  for (int y = 0; y < map.height * by; ++y)
    for (int x = 0; x < map.width * by; ++x)
      for (int c = 0; c < 3; ++c)
        map.rgb[std::size_t(3 * (x / by + y / by * map.width) + c)] +=
            large->rgb[std::size_t(3 * (x + y * large->width) + c)] / (by * by);
  return std::make_shared<const scene::EnvironmentMap>(std::move(map));
}

// The light of a scene that has that sky, with the small one instead.
inline scene::EnvironmentLight with_small_map(const scene::EnvironmentLight& light) {
  return scene::make_map_environment(small_courtyard(), light.to_map, light.scale, light.source);
}

}  // namespace airlight::gpu::test
