// Multiple scattering on a grid by the diffusion (P1) approximation, with light that leaves the box: what Zhou et al. 2008, Eq. 13, solve at
// the centres of Gaussians without a boundary.
//
//   div F + (1 - albedo) s L0 = s J0,   F = kappa (-grad L0 + s J1),   kappa = 1 / (3 s (1 - albedo g)),   s: extinction
//
// L(w) = L0 + L1.w with L1 = 3 F; J(w) = J0 + J1.w is J_ss, in propagation directions. At the faces Marshak's condition: the light that comes
// in has no flux, F.n = L0 / 2. Finite volumes, harmonic means of kappa between cells, conjugate gradients with an incomplete Cholesky factor.
#pragma once
#include <memory>

#include "methods/compensated_ray_marching/discrete_ordinates.h"

namespace airlight::compensated_ray_marching {

struct P1Options {
  double tolerance = 2e-4;  // residual, relative to the right side
  int iterations = 200;     // at most, for each light
};

struct P1Solution {
  Moments radiance;    // M_lm of the light that has been scattered; of bands above the first two 0
  int iterations = 0;  // of all lights
  double error = 0;    // the greatest residual; above the tolerance where iterations ran out
};

// Extinction that kappa has at least [1/m], for in a vacuum it would have no end: a depth of 0.03 over the longest side of the box. Throws
// Error for a grid without cells or without ends.
double extinction_of_vacuum(const OrdinateGrid&);

class P1Grid {
 public:
  // extinction: of each node [1/m], >= 0. albedo in [0, 1]; g: mean cosine of the phase function. Throws Error for what does not fit or is
  // out of range.
  P1Grid(const OrdinateGrid&, const Eigen::ArrayXd& extinction, double albedo, double g, const P1Options&);

  // source: J_ss, order^2 coefficients of each light, one light after another; the first four of each count. before: the radiance of a
  // solution to start from, or null.
  P1Solution solve(const Moments& source, int order, const Moments* before = nullptr) const;

 private:
  struct System;
  std::shared_ptr<const System> system_;
};

}  // namespace airlight::compensated_ray_marching
