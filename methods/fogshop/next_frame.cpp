#include "methods/fogshop/next_frame.h"

#include <algorithm>

#include "scene/light/same_light.h"

namespace airlight::fogshop {
namespace {

bool same_gaussians(const GaussianArrays& a, const GaussianArrays& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.a == b.a && a.half_depth == b.half_depth &&
         a.radius_squared == b.radius_squared;
}

std::vector<scene::Light> environments(const scene::Scene& scene) {
  std::vector<scene::Light> found;
  for (const scene::Light& light : scene.lights)
    if (std::holds_alternative<scene::EnvironmentLight>(light)) found.push_back(light);
  return found;
}

}  // namespace

Unchanged unchanged(const scene::Scene& before, const Model& model_before, const scene::Scene& now,
                    const Model& model) {
  Unchanged same_parts;
  same_parts.gaussians =
      model_before.threshold == model.threshold && same_gaussians(model_before.gaussians, model.gaussians);
  const Fog &a = model_before.fog, &b = model.fog;
  same_parts.fog = same_parts.gaussians && model_before.gaussians.colour == model.gaussians.colour &&
                   a.sum.constant == b.sum.constant && (a.extinction_ratio == b.extinction_ratio).all() &&
                   (a.albedo == b.albedo).all() && (a.constant_colour == b.constant_colour).all() && a.g == b.g;
  same_parts.surfaces = same_surfaces(before, now);
  const auto lights_before = environments(before), lights = environments(now);
  same_parts.environments =
      std::equal(lights_before.begin(), lights_before.end(), lights.begin(), lights.end(), scene::same_light);
  return same_parts;
}

bool camera_alone_moved(const scene::Scene& before, const scene::Scene& now) {
  return !now.hash.empty() && before.matter_hash == now.matter_hash && before.light_hash == now.light_hash &&
         same_surfaces(before, now) && before.backdrops == now.backdrops &&
         (before.ambient_in_scatter == now.ambient_in_scatter).all();
}

const LightModel* light_at(const Model& model, const Point3& position) {
  const auto found = std::find_if(model.lights.begin(), model.lights.end(),
                                  [&](const LightModel& light) { return light.position == position; });
  return found == model.lights.end() ? nullptr : &*found;
}

}  // namespace airlight::fogshop
