// Light in Legendre boxes in compute shaders: the variant `ray` of methods/legendre_fluids, the same settings and layers, in single
// precision.
#pragma once
#include "gpu/context.h"
#include "scene/flow/flow.h"

namespace airlight::gpu::legendre_fluids {

class LegendreLight final : public scene::Renderer {
 public:
  std::string name() const override { return "legendre_fluids_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

// A density of a flow of LegendreFluids in three dimensions becomes the density of a medium, counted among the scene's media that extinguish:
// from step to picture nothing leaves the device. Variant `ray` draws a density below 0 towards its mean until it is not. False, and nothing is
// done, where the picture was not prepared by LegendreLight, where its medium is no Legendre box of the flow's box and coefficients, or where
// variant `paper` has several media.
bool draw_flow(scene::Prepared&, const scene::Flow&, int density = 0, std::size_t medium = 0);

}  // namespace airlight::gpu::legendre_fluids
