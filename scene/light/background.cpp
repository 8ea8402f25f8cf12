#include "scene/light/background.h"

#include <algorithm>

namespace airlight::scene {

bool has_environment(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const Light& light) { return std::holds_alternative<EnvironmentLight>(light); });
}

Rgb background(const Scene& scene, const Vec3& direction) {
  Rgb sum = Rgb::Zero();
  for (const Light& light : scene.lights)
    if (const auto* environment = std::get_if<EnvironmentLight>(&light)) sum += radiance(*environment, direction);
  return sum;
}

Rgb background(const Scene& scene, const RayEnd& end, const Vec3& direction) {
  if (end.seen) return *end.seen;
  return end.on_ball ? Rgb(Rgb::Zero()) : background(scene, direction);
}

}  // namespace airlight::scene
