#include "scene/convert/fit_trust_region.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <cmath>

#include "scene/error.h"

namespace airlight::scene {
namespace {

constexpr int brick = 4;
using Five = std::array<double, 5>;

// E at the voxels of a brick, as a function of the Gaussians near it.
class Brick : public ceres::CostFunction {
 public:
  Brick(Eigen::Vector3i at, Eigen::Vector3i size, std::vector<double> density, std::size_t gaussians)
      : at_(at), size_(size), density_(std::move(density)) {
    set_num_residuals(int(density_.size()));
    for (std::size_t i = 0; i < gaussians; ++i) mutable_parameter_block_sizes()->push_back(5);
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    for (std::size_t v = 0; v < density_.size(); ++v) residuals[v] = -density_[v];
    for (std::size_t i = 0; i < parameter_block_sizes().size(); ++i) {
      const double *g = x[i], r2 = g[3] * g[3];
      double* const jacobian = jacobians ? jacobians[i] : nullptr;
      std::size_t v = 0;
      for (int c = 0; c < size_[2]; ++c)
        for (int b = 0; b < size_[1]; ++b)
          for (int a = 0; a < size_[0]; ++a, ++v) {
            const double dx = at_[0] + a - g[0], dy = at_[1] + b - g[1], dz = at_[2] + c - g[2];
            const double d2 = dx * dx + dy * dy + dz * dz;
            const double value = d2 < 9 * r2 ? std::exp(-d2 / r2) : 0;
            residuals[v] += g[4] * value;
            if (!jacobian) continue;
            const double by_center = 2 * g[4] / r2 * value;
            double* const row = jacobian + 5 * v;
            row[0] = by_center * dx;
            row[1] = by_center * dy;
            row[2] = by_center * dz;
            row[3] = by_center * d2 / g[3];
            row[4] = value;
          }
    }
    for (std::size_t v = 0; v < density_.size(); ++v)
      if (!std::isfinite(residuals[v])) return false;
    return true;
  }

 private:
  Eigen::Vector3i at_, size_;
  std::vector<double> density_;
};

// Does the ball reach the brick?
bool meets(const Gaussian& g, const Eigen::Vector3i& at, const Eigen::Vector3i& size) {
  const Point3 lo = at.cast<double>(), hi = (at + size).cast<double>().array() - 1;
  const double reach = 3.5 * g.width;  // some way beyond the cutoff, for it will move
  return (g.center.cwiseMax(lo).cwiseMin(hi) - g.center).squaredNorm() < reach * reach;
}

}  // namespace

Minimization minimize_trust_region(FitObjective<float>& objective, const FitBounds& bounds,
                                   std::vector<Gaussian>& gaussians, const MinimizerOptions& options) {
  Minimization result;
  result.value = objective.value(gaussians);
  if (gaussians.empty()) return result;
  std::vector<Five> x(gaussians.size());
  ceres::Problem problem;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    for (int v = 0; v < 5; ++v) x[i][std::size_t(v)] = variable(gaussians[i], v);
    problem.AddParameterBlock(x[i].data(), 5);
    for (int v = 0; v < 5; ++v) {
      problem.SetParameterLowerBound(x[i].data(), v, bounds.lo(v));
      problem.SetParameterUpperBound(x[i].data(), v, bounds.hi(v));
    }
  }
  const Eigen::Vector3i whole = objective.size();
  for (int z = 0; z < whole[2]; z += brick)
    for (int y = 0; y < whole[1]; y += brick)
      for (int x0 = 0; x0 < whole[0]; x0 += brick) {
        const Eigen::Vector3i at(x0, y, z), size = (whole - at).cwiseMin(brick);
        std::vector<double*> near;
        for (std::size_t i = 0; i < gaussians.size(); ++i)
          if (meets(gaussians[i], at, size)) near.push_back(x[i].data());
        if (near.empty()) continue;
        auto* const residuals = new Brick(at, size, objective.densities(at, size), near.size());  // the problem's
        problem.AddResidualBlock(residuals, nullptr, near);
      }
  if (options.check) options.check();
  ceres::Solver::Options solver;
  solver.max_num_iterations = options.iterations;
  solver.function_tolerance = options.tolerance;
  solver.linear_solver_type = gaussians.size() <= 400 ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::CGNR;
  solver.preconditioner_type = ceres::JACOBI;
  solver.max_linear_solver_iterations = 50;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE) throw Error("Ceres' trust region failed: " + summary.message);
  std::vector<Gaussian> trial = gaussians;
  for (std::size_t i = 0; i < trial.size(); ++i) {
    for (int v = 0; v < 5; ++v) variable(trial[i], v) = x[i][std::size_t(v)];
    clamp_to(bounds, trial[i]);
  }
  const double value = objective.value(trial);
  result.iterations = int(summary.iterations.size()) - 1;
  result.converged = summary.termination_type == ceres::CONVERGENCE || !(value < result.value);
  if (value < result.value) {
    gaussians = trial;
    result.value = value;
  }
  return result;
}

}  // namespace airlight::scene
