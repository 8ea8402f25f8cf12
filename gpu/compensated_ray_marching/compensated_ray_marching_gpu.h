// Compensated ray marching in compute shaders: the variant `grid` of methods/compensated_ray_marching, the same settings and layers, in
// single precision. Depths towards the light are the processor's, once; everything that depends on light or camera is the device's.
#pragma once
#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class CompensatedRayMarchingGpu final : public scene::Renderer {
 public:
  std::string name() const override { return "compensated_ray_marching_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::gpu
