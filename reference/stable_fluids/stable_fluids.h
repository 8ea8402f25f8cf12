// Stable Fluids: Stam, "Stable Fluids" (SIGGRAPH 1999), on a staggered grid, in two or three dimensions: the reference for
// flows. A step adds forces, advects, diffuses, projects; then what the flow carries is advected with the new velocity.
#pragma once
#include "scene/flow/flow.h"

namespace airlight::stable_fluids {

class StableFluids : public scene::Solver {
 public:
  std::string name() const override { return "stable_fluids"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::FlowProblem&, const scene::Settings&) const override;
  int steps_per_frame(const scene::FlowProblem&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Flow> start_supported(std::shared_ptr<const scene::FlowProblem>, const scene::Settings&,
                                               const scene::Execution&) const override;
};

}  // namespace airlight::stable_fluids
