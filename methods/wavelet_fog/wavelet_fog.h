// Fogmaps by B-spline wavelets: the transmittance of a map of fog over the ground, and its constant in-scattered light.
// Giroud and Biri 2010. README.md says which variants, how accurate.
//
// Layers: transmittance, ambient = ambient_in_scatter (1 - transmittance), surface (lights through the fog, reflected,
// through the fog), airlight (directional lights, scattered once by the fog; with the setting sun), mean = their sum.
#pragma once
#include "scene/renderer.h"

namespace airlight::wavelet_fog {

class WaveletFog final : public scene::Renderer {
 public:
  std::string name() const override { return "wavelet_fog"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::wavelet_fog
