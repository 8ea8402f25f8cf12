// A fit by Ceres' line search: L-BFGS, bounds by a sigmoid.
#pragma once
#include "scene/convert/fit_bounds.h"
#include "scene/convert/fit_objective.h"

namespace airlight::scene {

// Zhou et al. 2008, section 5.1, uses L-BFGS-B; Ceres' line search knows no bounds, so that a variable is lo + (hi - lo) sigmoid(q). Each
// Gaussian's q is counted in units of its own five variables' Gauss-Newton matrix, as if it were alone. Throws Error where Ceres fails.
Minimization minimize_lbfgs(FitObjective<float>&, const FitBounds&, std::vector<Gaussian>&, const MinimizerOptions&);

}  // namespace airlight::scene
