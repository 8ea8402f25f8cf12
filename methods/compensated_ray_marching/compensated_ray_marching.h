// Smoke under environments with multiple scattering: Zhou, Ren, Lin, Bao, Guo, Shum, "Real-time smoke rendering using compensated ray
// marching" (SIGGRAPH 2008). README.md says which variants, how accurate.
//
// Layers: airlight (light that the smoke scattered towards the camera, any number of times), surface (what stands behind, lit through the
// smoke and seen through it), transmittance, ambient = ambient_in_scatter (1 - transmittance), mean = their sum.
#pragma once
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {

class CompensatedRayMarching final : public scene::Renderer {
 public:
  std::string name() const override { return "compensated_ray_marching"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::compensated_ray_marching
