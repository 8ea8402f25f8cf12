#include "gpu/environment_lights.h"

#include <cmath>

#include "scene/base/error.h"

namespace airlight::gpu {
namespace {

enum Kind { constant, map, harmonics };  // as common/environment.glsl

std::vector<float> coefficients(const std::vector<Rgb>& sh) {
  std::vector<float> values;
  for (const Rgb& c : sh) values.insert(values.end(), {float(c[0]), float(c[1]), float(c[2])});
  return values;
}

}  // namespace

EnvironmentLights::EnvironmentLights(Context& context, const scene::Scene& scene) {
  for (const scene::Light& light : scene.lights) {
    const auto* e = std::get_if<scene::EnvironmentLight>(&light);
    if (!e) continue;
    Light l{constant, 1, 0, 0, e->scale, e->to_map, nullptr, e->map};
    if (e->map) {
      l.kind = map;
      l.width = e->map->width;
      l.height = e->map->height;
      l.values = std::make_unique<Buffer>(context, "environment map", e->map->rgb);
    } else if (!e->sh.empty()) {
      l.kind = harmonics;
      l.order = int(std::lround(std::sqrt(double(e->sh.size()))));
      l.values = std::make_unique<Buffer>(context, "environment harmonics", coefficients(e->sh));
    }
    lights_.push_back(std::move(l));
  }
}

bool EnvironmentLights::become(const scene::Scene& scene) {
  std::vector<const scene::EnvironmentLight*> others;
  for (const scene::Light& light : scene.lights)
    if (const auto* e = std::get_if<scene::EnvironmentLight>(&light)) others.push_back(e);
  const auto same = [](const Light& l, const scene::EnvironmentLight* e) {
    const bool map_too = l.from == e->map || (l.from && e->map && l.width == e->map->width &&
                                              l.height == e->map->height && l.from->rgb == e->map->rgb);
    return map_too && (l.kind == harmonics) == !e->sh.empty() &&
           (l.kind != harmonics || std::size_t(l.order) * l.order == e->sh.size());
  };
  if (!std::equal(lights_.begin(), lights_.end(), others.begin(), others.end(), same)) return false;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    lights_[i].scale = others[i]->scale;
    lights_[i].to_map = others[i]->to_map;
    lights_[i].from = others[i]->map;
    if (lights_[i].kind == harmonics) lights_[i].values->upload(coefficients(others[i]->sh));
  }
  return true;
}

const Buffer& EnvironmentLights::texels(const std::shared_ptr<const scene::EnvironmentMap>& map) const {
  for (const Light& l : lights_)
    if (l.from == map) return *l.values;
  throw Error("a map of no environment");
}

std::map<std::string, std::string> EnvironmentLights::definitions(int light) const {
  return {{"KIND", std::to_string(lights_[light].kind)}, {"SH_ORDER", std::to_string(lights_[light].order)}};
}

void EnvironmentLights::bind(int light, LinkedProgram& p) const {
  const Light& l = lights_[light];
  if (l.values) l.values->bind(9);
  if (l.kind == map) {
    p.set("map_width", l.width);
    p.set("map_height", l.height);
  }
  if (l.kind == harmonics) p.set("sh_order", l.order);
  p.set("scale", l.scale);
  p.set("to_map", l.to_map);
}

}  // namespace airlight::gpu
