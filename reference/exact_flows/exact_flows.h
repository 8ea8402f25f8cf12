// Flows whose solution is known in closed form: what solvers are judged against. Everything else is refused by name.
//
//   velocity                         where                               at time t
//   rest, wind                       periodic along the wind             as it began
//   Taylor-Green                     periodic or free-slip sides         exp(-viscosity (kx^2 + ky^2) t) times the start
//   any, with velocity_stays         anywhere                            as it began
//
//   carried                          by                                  at time t
//   uniform                          any                                 exp(-decay t) times the start
//   start                            wind, rotation; no diffusion        the start where it came from, times that
//   wave                             wind, periodic                      moved, and exp(-diffusivity k^2 t) times that
#pragma once
#include "scene/flow/flow.h"

namespace airlight::exact_flows {

class ExactFlows : public scene::Solver {
 public:
  std::string name() const override { return "exact"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::FlowProblem&, const scene::Settings&) const override;
  int steps_per_frame(const scene::FlowProblem&, const scene::Settings&) const override { return 1; }

 private:
  std::unique_ptr<scene::Flow> start_supported(std::shared_ptr<const scene::FlowProblem>, const scene::Settings&,
                                               const scene::Execution&) const override;
};

}  // namespace airlight::exact_flows
