// A flow on a grid, in either precision: the fields, and the order in which a step treats them.
#pragma once
#include "reference/stable_fluids/advection.h"
#include "reference/stable_fluids/pressure.h"
#include "scene/flow/flow.h"

namespace airlight::stable_fluids {

struct Plan {
  int longest = 64;  // cells along the longest axis
  Advection advection;
  PressureSolver pressure = PressureSolver::transforms;
  double tolerance = 1e-6;  // of conjugate gradients
  int iterations = 2000;    // most iterations of conjugate gradients
  bool project_twice = false;
  int threads = 0;
};

// Throws Error: a box that the cells do not divide, obstacles that fill it, flow into a closed box.
std::unique_ptr<scene::Flow> start_float(std::shared_ptr<const scene::FlowProblem>, const Plan&);
std::unique_ptr<scene::Flow> start_double(std::shared_ptr<const scene::FlowProblem>, const Plan&);

}  // namespace airlight::stable_fluids
