// Brute force: single scattering by steps along every camera ray, and from each of them by steps along a shadow ray to
// every light. Deterministic; any medium, any light. It is the baseline that the methods' speed-ups are measured
// against, so it is made fast: vector kernels in float chosen at run time, empty space left out, all threads.
//
// Error: order 2 in the step length where density and light are smooth between the cuts that regions and supports make;
// for a trilinear grid order 2 with a constant that jumps about, since kinks fall anywhere within steps; order 1 where
// a shadow's edge, or the jump of a cut-off Gaussian, falls within a step. See README.md.
#pragma once
#include "scene/renderer.h"

namespace airlight::ray_marcher {

class RayMarcher final : public scene::Renderer {
 public:
  std::string name() const override { return "ray_marcher"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::ray_marcher
