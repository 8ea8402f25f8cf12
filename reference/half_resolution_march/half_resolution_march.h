// Fog as in many games of today: light scattered once, marched by jittered steps at half the film's resolution, blurred and upsampled
// with regard to depth. Extinction and light come from LitMedia: maps of the lights, or no shadow of the medium on itself.
//
// Scheme after "Volumetric Lights" for Unity (SlightlyMad, 2016) and INSIDE (Gjoel and Svendsen, GDC 2016); README.md says what differs.
#pragma once
#include "scene/renderer.h"

namespace airlight::half_resolution_march {

class HalfResolutionMarch final : public scene::Renderer {
 public:
  std::string name() const override { return "half_resolution_march"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::half_resolution_march
