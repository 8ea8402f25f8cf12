// A fit by Ceres' line search: L-BFGS, bounds by a sigmoid.
#pragma once
#include "scene/convert/fit_bounds.h"
#include "scene/convert/fit_objective.h"

namespace airlight::scene {

// Zhou et al. 2008, section 5.1, uses L-BFGS-B; Ceres' line search knows no bounds, so that a variable is lo + (hi - lo) sigmoid(q). With
// `blocks`, q of each Gaussian is counted in units of its own five variables' Gauss-Newton matrix, as if it were alone; else a length
// counts 0.05 of the unit and an amplitude half the greatest density, as the publication's. Throws Error where Ceres fails.
Minimization minimize_lbfgs(FitObjective<float>&, const FitBounds&, std::vector<Gaussian>&, const MinimizerOptions&,
                            bool blocks);

}  // namespace airlight::scene
