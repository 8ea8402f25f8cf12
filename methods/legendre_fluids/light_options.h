// Settings of the renderer, and what its variants cannot do.
#pragma once
#include "methods/legendre_fluids/light_rays.h"
#include "methods/legendre_fluids/paper_light.h"
#include "scene/base/settings.h"

namespace airlight::legendre_fluids {

struct LightOptions {
  enum class Variant { ray, paper } variant = Variant::ray;
  RayOptions ray;
  PaperOptions paper;
};

std::vector<scene::SettingSpec> light_settings();
LightOptions read_light_options(const scene::Settings&);
// The scene that `ray` renders: with directional lights for each environment that lights something.
std::shared_ptr<const scene::Scene> with_sky(std::shared_ptr<const scene::Scene>, const RayOptions&);
std::vector<std::string> unsupported_light(const scene::Scene&, const LightOptions&);

}  // namespace airlight::legendre_fluids
