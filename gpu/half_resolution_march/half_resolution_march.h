// The half-resolution march in compute shaders: the settings and the steps of reference/half_resolution_march.
#pragma once
#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu::half_resolution_march {

class HalfResolutionMarch final : public scene::Renderer {
 public:
  std::string name() const override { return "half_resolution_march_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  // Reasons of the CPU, and limits of the shaders, one line each.
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;
  // Throws Unavailable without a device, or where it has no room.

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::gpu::half_resolution_march
