#include "scene/light/scattered_lights.h"

#include <algorithm>

namespace airlight::scene {
namespace {

// Intensity, irradiance, or what multiplies the radiance.
Rgb strength(const Light& light) {
  return match(
      light, [](const PointLight& point) { return point.intensity; },
      [](const SpotLight& spot) { return spot.intensity; }, [](const DirectionalLight& sun) { return sun.irradiance; },
      [](const EnvironmentLight& environment) { return environment.scale; });
}

}  // namespace

bool shines(const Light& light) { return (strength(light) != 0).any(); }

bool scatter(const std::vector<Medium>& media, const Light& light) {
  return std::any_of(media.begin(), media.end(), [&](const Medium& medium) {
    return extinguishes(medium) && (medium.albedo * medium.sigma_t * strength(light) != 0).any();
  });
}

std::vector<Light> scattered_lights(const Scene& scene) {
  std::vector<Light> lights;
  std::copy_if(scene.lights.begin(), scene.lights.end(), std::back_inserter(lights),
               [&](const Light& light) { return scatter(scene.media, light); });
  return lights;
}

std::string why_nothing_scatters(const Scene& scene) {
  const auto scattered = [&](const Light& light) { return scatter(scene.media, light); };
  if (std::any_of(scene.lights.begin(), scene.lights.end(), scattered)) return "";
  if (std::none_of(scene.media.begin(), scene.media.end(), extinguishes)) return "no medium extinguishes";
  if (std::none_of(scene.lights.begin(), scene.lights.end(), shines)) return "no light shines";
  return "the albedo is 0 where light shines";
}

}  // namespace airlight::scene
