// Fogshop on the GPU: the airlight of methods/fogshop in compute shaders, single precision, same settings, same layers.
#pragma once
#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu::fogshop {

class Fogshop final : public scene::Renderer {
 public:
  std::string name() const override { return "fogshop_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  // Does not need a GPU; prepare does, and throws Unavailable without one.
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::gpu::fogshop
