#include "reference/ray_marcher/shapes.h"

#include <algorithm>
#include <cmath>

namespace airlight::ray_marcher {

PhaseShape phase_shape(const scene::PhaseFunction& phase) {
  PhaseShape shape;
  shape.kind = PhaseShape::Kind(phase.index());
  if (const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase)) shape.g = float(hg->g);
  return shape;
}

LightShape light_shape(const scene::Light& light) {
  LightShape shape;
  const auto put = [](const Vec3& v, double* to) { std::copy(v.data(), v.data() + 3, to); };
  if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) {
    put(sun->to_light, shape.axis);
  } else if (const auto* point = std::get_if<scene::PointLight>(&light)) {
    shape.kind = LightShape::point;
    put(point->position, shape.position);
  } else if (const auto* spot = std::get_if<scene::SpotLight>(&light)) {
    shape.kind = LightShape::spot;
    put(spot->position, shape.position);
    put(spot->axis, shape.axis);
    shape.cos_inner = std::cos(spot->inner_angle);
    shape.cos_outer = std::cos(spot->outer_angle);
  }
  return shape;
}

Rgb light_colour(const scene::Light& light) {
  if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) return sun->irradiance;
  if (const auto* point = std::get_if<scene::PointLight>(&light)) return point->intensity;
  return std::get<scene::SpotLight>(light).intensity;
}

}  // namespace airlight::ray_marcher
