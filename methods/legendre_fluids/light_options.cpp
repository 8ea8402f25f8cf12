#include "methods/legendre_fluids/light_options.h"

#include <algorithm>

namespace airlight::legendre_fluids {

std::vector<scene::SettingSpec> light_settings() {
  using namespace scene;
  return {
      choice_setting("variant", "ray", {"ray"},
                     "ray: exact optical depths, Gauss points on panels of every camera ray"),
      integer_setting("points", "8", 2, 16, "of ray: Gauss points of a panel"),
      real_setting("tolerance", "1e-5", 1e-13, 0.1, "of ray: of a light's share of a pixel, relative"),
      integer_setting("shadow_steps", "64", 1, 65536,
                      "of ray: shadow rays over the media on a camera ray, where surfaces may stand before a light; "
                      "finds shadows wider than that"),
  };
}

LightOptions read_light_options(const scene::Settings& settings) {
  LightOptions o;
  o.variant = settings.choice<LightOptions::Variant>("variant");
  o.ray.points = int(settings.integer("points"));
  o.ray.tolerance = settings.real("tolerance");
  o.ray.shadow_steps = int(settings.integer("shadow_steps"));
  return o;
}

std::vector<std::string> reasons_against_light(const scene::Scene& scene, const LightOptions&) {
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    if (const std::string why = field_against(scene.media, i); !why.empty()) reasons.push_back(why);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const std::string why = scene::unknown_light<scene::DirectionalLight, scene::EnvironmentLight>(scene.lights, i);
        !why.empty())
      reasons.push_back(why);
  return reasons;
}

}  // namespace airlight::legendre_fluids
