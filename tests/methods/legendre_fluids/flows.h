// Whole flows of Legendre fluids for tests.
#pragma once
#include <map>
#include <string>

#include "methods/legendre_fluids/legendre_fluids.h"

namespace airlight::legendre_fluids::testing {

using scene::FlowProblem;
using Given = std::map<std::string, std::string>;

template <class Solver = LegendreFluids>
std::unique_ptr<scene::Flow> start(const FlowProblem& problem, const Given& settings) {
  const Solver solver;
  return solver.start(std::make_shared<const FlowProblem>(problem), scene::Settings(solver.settings(), settings), {});
}

inline std::vector<std::string> objections(const FlowProblem& problem, const Given& settings = {}) {
  const LegendreFluids solver;
  return solver.supports(problem, scene::Settings(solver.settings(), settings));
}

inline FlowProblem box(int dimensions, const Vec3& size = Vec3::Ones()) {
  FlowProblem problem;
  problem.dimensions = dimensions;
  problem.box = {Point3::Zero(), dimensions == 2 ? Point3(size[0], size[1], 0) : Point3(size)};
  return problem;
}

inline void run(scene::Flow& flow, int steps, double dt) {
  for (int i = 0; i < steps; ++i) flow.step(dt);
}

}  // namespace airlight::legendre_fluids::testing
