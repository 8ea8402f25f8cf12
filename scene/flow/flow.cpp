#include "scene/flow/flow.h"

#include "scene/base/device_check.h"
#include "scene/base/error.h"

namespace airlight::scene {

void Flow::add(const Push&) { throw Error("this flow takes no further forces"); }

std::vector<Vec3> Flow::velocities(const std::vector<Point3>& points) const {
  std::vector<Vec3> u;
  for (const Point3& x : points) u.push_back(velocity(x));
  return u;
}

std::unique_ptr<Flow> Solver::start(std::shared_ptr<const FlowProblem> problem, const Settings& settings,
                                    const Execution& execution) const {
  const std::vector<std::string> reasons = supports(*problem, settings);
  if (!reasons.empty()) throw NotSupported(name() + ": " + reasons.front(), reasons.front());
  check_device(*this);
  if (problem->file.empty()) return start_supported(std::move(problem), settings, execution);
  try {
    return start_supported(problem, settings, execution);
  } catch (const Error& e) {
    throw Error(problem->file + ": " + e.what(), e.exit_code());
  }
}

}  // namespace airlight::scene
