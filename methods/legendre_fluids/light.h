// Light in Legendre boxes: Gupta and Narasimhan, "Legendre Fluids" (SCA 2007), section 6. README.md says which variants, how accurate.
//
// Layers: airlight (directional lights and environments, scattered once), surface (lit by them through the media, seen through the media), transmittance,
// ambient = ambient_in_scatter (1 - transmittance), mean = their sum.
#pragma once
#include "scene/renderer.h"

namespace airlight::legendre_fluids {

class LegendreLight final : public scene::Renderer {
 public:
  std::string name() const override { return "legendre_fluids"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::legendre_fluids
