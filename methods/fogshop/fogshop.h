// "Fogshop": single scattering of point lights in a sum of Gaussians, in closed form. Zhou, Hou, Gong, Snyder, Guo,
// Shum 2007. README.md says which equations, which variants, how accurate.
//
// Layers: airlight, surface, transmittance, mean = airlight + surface. Where the medium does not extinguish a colour
// its transmittance is 1 and its airlight 0. An infinite ray in a constant medium ends in transmittance 0.
#pragma once
#include "scene/renderer.h"

namespace airlight::fogshop {

struct Options;

// Reasons why the scene cannot be rendered with these options, one line each; empty if it can.
std::vector<std::string> unsupported(const scene::Scene&, const Options&);

class Fogshop final : public scene::Renderer {
 public:
  std::string name() const override { return "fogshop"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::fogshop
