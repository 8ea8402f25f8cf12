// Froxel fog in compute shaders: the settings and the grid of reference/froxel_fog.
#pragma once
#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu::froxel_fog {

class FroxelFog final : public scene::Renderer {
 public:
  std::string name() const override { return "froxel_fog_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  // Reasons of the CPU, and limits of single precision, one line each.
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;
  // Throws Unavailable without a device, or where it has no room for grids, maps or froxels.

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::gpu::froxel_fog
