// Compensated ray marching in compute shaders: both variants of methods/compensated_ray_marching, the same settings and layers. `grid` in
// single precision: depths towards the light are the processor's, once, what depends on light or camera is the device's. `paper`: all but
// tables is the device's, sources at the centres in double precision, the march in single.
#pragma once
#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu::compensated_ray_marching {

class CompensatedRayMarching final : public scene::Renderer {
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

}  // namespace airlight::gpu::compensated_ray_marching
