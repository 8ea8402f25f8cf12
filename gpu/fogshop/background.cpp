#include "gpu/fogshop/background.h"

#include <cmath>

#include "gpu/view_uniforms.h"

namespace airlight::gpu::fog {
namespace {

enum Kind { constant, map, harmonics };  // as fogshop/background.comp

std::vector<float> coefficients(const std::vector<Rgb>& sh) {
  std::vector<float> values;
  for (const Rgb& c : sh) values.insert(values.end(), {float(c[0]), float(c[1]), float(c[2])});
  return values;
}

}  // namespace

Background::Background(Context& context, const scene::Scene& scene, const FogOnDevice& fog) : context_(context) {
  const Use use(context_);
  for (const scene::Light& light : scene.lights) {
    const auto* e = std::get_if<scene::EnvironmentLight>(&light);
    if (!e) continue;
    Light l{constant, 1, 0, 0, e->scale, e->to_map, nullptr, nullptr};
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
    l.program = &fog.program("fogshop/background.comp", {{"LOCAL_SIZE_X", "8"},
                                                         {"LOCAL_SIZE_Y", "8"},
                                                         {"KIND", std::to_string(l.kind)},
                                                         {"SH_ORDER", std::to_string(l.order)}});
    lights_.push_back(std::move(l));
  }
}

void Background::draw(const FogOnDevice& fog, const scene::View& view, const Buffer* distances, const Buffer* pixels,
                      const Buffer& surface) {
  const Use use(context_);
  for (const Light& light : lights_) {
    Program& p = *light.program;
    fog.use(p);
    fog.bind();
    if (distances) distances->bind(3);
    if (pixels) pixels->bind(6);
    surface.bind(7);
    if (light.values) light.values->bind(9);
    set_view(p, view);
    p.set("has_distances", distances != nullptr);
    p.set("has_airlight", pixels != nullptr);
    if (light.kind == map) {
      p.set("map_width", light.width);
      p.set("map_height", light.height);
    }
    if (light.kind == harmonics) p.set("sh_order", light.order);
    p.set("scale", light.scale);
    p.set("to_map", light.to_map);
    p.dispatch(view.width, view.height);
  }
}

}  // namespace airlight::gpu::fog
