// A fit by Ceres' trust region: Levenberg-Marquardt with bounds, a residual for every voxel.
#pragma once
#include "scene/convert/fit_bounds.h"
#include "scene/convert/fit_objective.h"

namespace airlight::scene {

// One residual block for every cube of 4^3 voxels, of the Gaussians within reach of it at the start; sparse Cholesky up to 400 of them,
// conjugate gradients with block Jacobi above. Its Jacobian has five numbers for every sample of every ball, 5 x 8 x 6000 bytes a
// Gaussian at 128^3: for small grids, to compare with. Result as the objective's value() has it; one thread.
Minimization minimize_trust_region(FitObjective<float>&, const FitBounds&, std::vector<Gaussian>&,
                                   const MinimizerOptions&);

}  // namespace airlight::scene
