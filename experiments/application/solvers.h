// Everything that can solve a flow problem. A new solver joins the list in solvers.cpp.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scene/flow/flow.h"

namespace airlight::experiments {

const std::vector<std::unique_ptr<scene::Solver>>& all_solvers();

// Throws Error, beginning with `where`, that names the nearest solver.
const scene::Solver& find_solver(const std::string& name, const std::string& where);

}  // namespace airlight::experiments
