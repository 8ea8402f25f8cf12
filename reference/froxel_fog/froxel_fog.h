// Froxel fog, the fog of most engines: media and light are sampled on a coarse grid that the view frustum is divided into, accumulated over
// jittered frames, filtered, integrated front to back and looked up by every pixel (Wronski 2014; Hillaire 2015). Light scattered once.
// Presets are the defaults of Unity HDRP and of Godot 4, or a grid that is fitted to the media. See README.md.
//
// Error: order 2 in the slices and in the cell's side where media and light are smooth; order 1 in slices where surfaces end the rays, and
// whatever the size at their edges. Without self_shadow the light is too bright whatever the grid.
#pragma once
#include "scene/renderer.h"

namespace airlight::froxel_fog {

class FroxelFog final : public scene::Renderer {
 public:
  std::string name() const override { return "froxel_fog"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::froxel_fog
