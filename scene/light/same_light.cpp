#include "scene/light/same_light.h"

#include <algorithm>

namespace airlight::scene {
namespace {

bool same(const Rgb& a, const Rgb& b) { return (a == b).all(); }

bool same(const PointLight& a, const PointLight& b) {
  return a.position == b.position && same(a.intensity, b.intensity) && a.radius == b.radius;
}

bool same(const SpotLight& a, const SpotLight& b) {
  return a.position == b.position && a.axis == b.axis && a.inner_angle == b.inner_angle &&
         a.outer_angle == b.outer_angle && same(a.intensity, b.intensity) && a.radius == b.radius;
}

bool same(const DirectionalLight& a, const DirectionalLight& b) {
  return a.to_light == b.to_light && same(a.irradiance, b.irradiance);
}

bool same(const EnvironmentLight& a, const EnvironmentLight& b) {
  return same(a.scale, b.scale) && a.to_map == b.to_map && a.map == b.map &&
         std::equal(a.sh.begin(), a.sh.end(), b.sh.begin(), b.sh.end(),
                    [](const Rgb& x, const Rgb& y) { return same(x, y); });
}

}  // namespace

bool same_light(const Light& a, const Light& b) {
  return a.index() == b.index() &&
         std::visit([&](const auto& light) { return same(light, std::get<std::decay_t<decltype(light)>>(b)); }, a);
}

bool same_rays(const Light& a, const Light& b) {
  if (a.index() != b.index()) return false;
  Light powered = a;
  if (auto* point = std::get_if<PointLight>(&powered)) point->intensity = std::get<PointLight>(b).intensity;
  if (auto* spot = std::get_if<SpotLight>(&powered)) spot->intensity = std::get<SpotLight>(b).intensity;
  if (auto* sun = std::get_if<DirectionalLight>(&powered)) sun->irradiance = std::get<DirectionalLight>(b).irradiance;
  return same_light(powered, b);
}

}  // namespace airlight::scene
