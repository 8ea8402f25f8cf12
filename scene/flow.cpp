#include "scene/flow.h"

namespace airlight::scene {

std::unique_ptr<Flow> Solver::start(std::shared_ptr<const FlowProblem> problem, const Settings& settings,
                                    const Execution& execution) const {
  const std::vector<std::string> reasons = supports(*problem, settings);
  if (!reasons.empty()) throw NotSupported(name() + ": " + reasons.front(), reasons.front());
  return start_supported(std::move(problem), settings, execution);
}

}  // namespace airlight::scene
