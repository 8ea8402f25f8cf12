#include "methods/compensated_ray_marching/compensated_ray_marching.h"

#include "methods/compensated_ray_marching/picture.h"

namespace airlight::compensated_ray_marching {

std::string CompensatedRayMarching::about() const {
  return "smoke under environments, multiple scattering on a grid or at the centres of Gaussians (Zhou et al. 2008)";
}

std::vector<scene::SettingSpec> CompensatedRayMarching::settings() const { return option_settings(); }

std::vector<std::string> CompensatedRayMarching::supports(const scene::Scene& scene,
                                                          const scene::Settings& settings) const {
  return unsupported(scene, read_options(settings));
}

std::unique_ptr<scene::Prepared> CompensatedRayMarching::prepare_supported(std::shared_ptr<const scene::Scene> scene,
                                                                           const scene::Settings& settings,
                                                                           const scene::Execution& execution) const {
  return prepare_picture(std::move(scene), read_options(settings), settings.canonical(), execution);
}

}  // namespace airlight::compensated_ray_marching
