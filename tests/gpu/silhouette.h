// Pixels where the rasteriser may show another surface than Embree: coverage is good to 1/256 pixel.
#pragma once
#include <algorithm>
#include <cmath>

#include "scene/renderer.h"

namespace airlight::gpu::test {

// Does what ends the ray change within 1/64 pixel? There either backend may show either side.
inline bool on_silhouette(const scene::Scene& scene, const scene::View& view, int x, int y) {
  Interval range;
  for (int k = 0; k <= 8; ++k) {
    const double r = k == 8 ? 0 : 1 / 64.0, dx = r * std::cos(k * pi / 4), dy = r * std::sin(k * pi / 4);
    const double t = ray_end(scene, camera_ray(view.camera, x + 0.5 + dx, y + 0.5 + dy, view.width, view.height)).t;
    range = {std::min(range.lo, t), std::max(range.hi, t)};
  }
  return range.hi > 1.02 * range.lo;
}

}  // namespace airlight::gpu::test
