// A fit by Gauss-Newton steps whose normal matrix never sees a voxel.
#pragma once
#include "scene/convert/fit_bounds.h"
#include "scene/convert/fit_objective.h"

namespace airlight::scene {

// Levenberg-Marquardt with projection onto the bounds. The products of derivatives that a normal matrix is made of are integrals over
// pairs of Gaussians, in closed form and 0 for pairs apart: 5 x 5 blocks, some sixty a Gaussian, in place of a Jacobian with a row for
// every voxel. They stand for sums over voxels, which they are to 1 % from a width of one voxel on; the objective and its gradient are
// exact, so that only the path depends on it. Steps by conjugate gradients, preconditioned by the blocks of the diagonal, among the
// variables that are not held at a bound. With `weights_only` centres and widths stay: the bounded linear least squares of amplitudes.
Minimization minimize_gauss_newton(FitObjective<float>&, const FitBounds&, std::vector<Gaussian>&,
                                   const MinimizerOptions&, bool weights_only = false);

}  // namespace airlight::scene
