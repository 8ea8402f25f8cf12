// methods/shadow_planes on the GPU: silhouettes, lists of their edges by angle and lit parts of rays in compute shaders,
// the latter in double precision; airlight in single precision.
#pragma once
#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu::shadow_planes {

class ShadowPlanes final : public scene::Renderer {
 public:
  std::string name() const override { return "shadow_planes_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;  // settings of shadow_planes, with fewer nodes
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::gpu::shadow_planes
