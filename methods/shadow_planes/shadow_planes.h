// Biri, Arques, Michelin, "Real Time Rendering of Atmospheric Scattering and Volumetric Shadows", WSCG 2006, in double
// precision: light of point and spot lights scattered once in homogeneous media, with exact shadows.
#pragma once
#include "scene/renderer.h"

namespace airlight::shadow_planes {

class ShadowPlanes final : public scene::Renderer {
 public:
  std::string name() const override { return "shadow_planes"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::shadow_planes
