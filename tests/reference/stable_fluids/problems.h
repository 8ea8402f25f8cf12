// Small flow problems that several tests start.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "reference/stable_fluids/stable_fluids.h"

namespace airlight::stable_fluids::testing {

using scene::FlowProblem;
using Kind = scene::Side::Kind;

inline FlowProblem box_problem(int dimensions, const Vec3& size, Kind sides = Kind::free_slip) {
  FlowProblem problem;
  problem.dimensions = dimensions;
  problem.box = {Point3::Zero(), dimensions == 2 ? Point3(size[0], size[1], 0) : Point3(size)};
  for (auto& axis : problem.sides)
    for (scene::Side& side : axis) side.kind = sides;
  return problem;
}

// Warm smoke that comes out of a ball near the floor.
inline FlowProblem plume(int dimensions) {
  FlowProblem problem = box_problem(dimensions, Vec3(1, 1, 1));
  problem.gravity = Vec3(0, -9.81, 0);
  problem.expansion = 1.0 / 300;
  scene::Source source;
  source.region = scene::Sphere{Point3(0.5, 0.2, dimensions == 2 ? 0 : 0.5), 0.12};
  source.density = 1;
  source.temperature = 150;
  problem.sources.push_back(source);
  return problem;
}

inline std::unique_ptr<scene::Flow> start(const FlowProblem& problem, std::map<std::string, std::string> settings,
                                          int threads = 0) {
  const StableFluids solver;
  settings.try_emplace("precision", "double");
  settings.try_emplace("n", "16");
  scene::Execution execution;
  execution.threads = threads;
  return solver.start(std::make_shared<const FlowProblem>(problem), scene::Settings(solver.settings(), settings),
                      execution);
}

inline void run(scene::Flow& flow, int steps, double dt) {
  for (int i = 0; i < steps; ++i) flow.step(dt);
}

}  // namespace airlight::stable_fluids::testing
