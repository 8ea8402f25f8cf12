// Multiple scattering as the publication solves it: the diffusion equation enforced at the centres of the Gaussians, for as many unknowns.
// Zhou et al. 2008, Eq. 13 and section 5.4.
//
//   div(kappa grad L0) - (1 - albedo) sigma_t D L0 = -sigma_t D J0 + sigma_t / (3 sigma_tr) div J1,   kappa = 1 / (3 sigma_tr D)
//
// D is the sum of all Gaussians, and every function between the centres the mean of its values there weighted with the Gaussians. Nothing
// says what happens at the edge of the smoke: the box is closed, no light leaves it.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "scene/media/gaussian_sum.h"

namespace airlight::compensated_ray_marching {

// J_ss as a mean and a direction: J(w) = J0 + J1.w.
struct LinearSource {
  double mean = 0;
  Vec3 direction = Vec3::Zero();
};
// Mean and direction of source radiance, from its bands 0 and 1 in propagation directions.
LinearSource linear_source(const double* harmonics);

struct DiffusionSystem {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;  // -> mean radiance L0 that has been scattered, at the centres
};

// `corrected`: as above. `as_printed`: J0 over the albedo, and without the 3 before sigma_tr. Gaussians are not cut. albedo: 0 is refused where
// it is divided by. g: mean cosine of the phase function. sigma_t [1/m].
enum class DiffusionForm { as_printed, corrected };
DiffusionSystem diffusion_system(const std::vector<scene::Gaussian>&, const std::vector<LinearSource>&, double sigma_t,
                                 double albedo, double g, DiffusionForm);

// The light that has been scattered, as a mean and a direction at the centres, for its mean there:
// L1 = 3 kappa (-grad L0 + sigma_t D J1); `as_printed`: without the 3.
std::vector<LinearSource> scattered_radiance(const std::vector<scene::Gaussian>&, const std::vector<LinearSource>&,
                                             const Eigen::VectorXd& mean, double sigma_t, double albedo, double g,
                                             DiffusionForm);

struct LeastSquares {
  Eigen::VectorXd x;
  int iterations = 0;
  double residual = 0;  // |A^T (b - A x)| relative to |A^T b|
};

// cg: conjugate gradients on A^T A x = A^T b, as the publication, which takes 20 to 40 from the frame before. lsqr: the same steps from the
// bidiagonalisation of A, which rounding spoils less (Paige and Saunders 1982). scaled: each row divided by its length first, which takes the
// condition of A down by up to 10; the residual is then that of the scaled rows.
enum class LeastSquaresSolver { cg, cg_scaled, lsqr, lsqr_scaled };

// From `start`, until the residual is `tolerance` or `iterations` are done.
LeastSquares solve_least_squares(const DiffusionSystem&, const Eigen::VectorXd& start, int iterations, double tolerance,
                                 LeastSquaresSolver);

}  // namespace airlight::compensated_ray_marching
