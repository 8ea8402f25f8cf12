#include "gpu/compensated_ray_marching/compensated_ray_marching.h"

#include "gpu/compensated_ray_marching/picture.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"

namespace airlight::gpu::compensated_ray_marching {

std::string CompensatedRayMarching::about() const {
  return "compensated_ray_marching in compute shaders: on a grid or at the centres of Gaussians (Zhou et al. 2008)";
}

std::vector<scene::SettingSpec> CompensatedRayMarching::settings() const {
  return airlight::compensated_ray_marching::CompensatedRayMarching().settings();
}

std::vector<std::string> CompensatedRayMarching::supports(const scene::Scene& scene,
                                                          const scene::Settings& settings) const {
  return unsupported_on_device(scene, airlight::compensated_ray_marching::read_options(settings));
}

std::unique_ptr<scene::Prepared> CompensatedRayMarching::prepare_supported(std::shared_ptr<const scene::Scene> scene,
                                                                           const scene::Settings& settings,
                                                                           const scene::Execution& execution) const {
  return std::make_unique<airlight::compensated_ray_marching::PreparedSequence<Picture>>(
      prepare_picture(std::move(scene), airlight::compensated_ray_marching::read_options(settings),
                      settings.canonical(), Solution{}, execution));
}

}  // namespace airlight::gpu::compensated_ray_marching
