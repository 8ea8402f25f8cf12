#include "methods/legendre_fluids/light.h"

#include "methods/legendre_fluids/light_options.h"
#include "methods/legendre_fluids/paper_picture.h"
#include "methods/legendre_fluids/ray_picture.h"

namespace airlight::legendre_fluids {

std::string LegendreLight::about() const {
  return "single scattering in Legendre boxes, exact optical depths along rays (Gupta and Narasimhan 2007, section 6)";
}

std::vector<scene::SettingSpec> LegendreLight::settings() const { return light_settings(); }

std::vector<std::string> LegendreLight::supports(const scene::Scene& scene, const scene::Settings& settings) const {
  return unsupported_light(scene, read_light_options(settings));
}

std::unique_ptr<scene::Prepared> LegendreLight::prepare_supported(std::shared_ptr<const scene::Scene> scene,
                                                                  const scene::Settings& settings,
                                                                  const scene::Execution&) const {
  const LightOptions options = read_light_options(settings);
  if (options.variant == LightOptions::Variant::paper)
    return prepare_paper(std::move(scene), options.paper, settings.canonical());
  return prepare_rays(std::move(scene), options.ray, settings.canonical());
}

}  // namespace airlight::legendre_fluids
