#include "scene/base/place_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace airlight::scene {

double place_error(const Scene& scene) {
  double worst = 0;
  for (const Medium& medium : scene.media) {
    const Box box = bounding_box(medium);
    if (box.empty() || !box.size().allFinite()) continue;
    const double length = box.size().stableNorm() + (box.center() - scene.camera.position).stableNorm();
    worst = std::max(worst, medium.sigma_t.maxCoeff() * density_bounds(medium, box).hi * length * 0x1p-53);
  }
  return worst;
}

std::string too_thick(const Scene& scene, double most) {
  const double error = place_error(scene);
  if (error <= most) return "";
  return fmt::format(
      "a medium is so thick that the rounding of places changes its optical depth by {:.2g}, expected at most {}: a "
      "smaller extinction, or a smaller scene",
      error, most);
}

}  // namespace airlight::scene
