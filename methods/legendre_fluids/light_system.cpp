#include "methods/legendre_fluids/light_system.h"

#include <fmt/format.h>

#include "methods/legendre_fluids/gmres.h"
#include "scene/base/error.h"

namespace airlight::legendre_fluids {

using scene::TensorShape;

DensityProduct::DensityProduct(const Eigen::VectorXd& density, const TensorShape& density_shape, const TensorShape& n,
                               LightTruncation truncation)
    : n_(n) {
  auto& [values, of_density, analysis] = matrices_;
  for (std::size_t a = 0; a < 3; ++a) {
    // All coefficients of the product for Chebyshev's truncation, those that are kept for the other.
    const int full = n[a] + density_shape[a] - 1;
    const int wanted = truncation == LightTruncation::chebyshev ? full : n[a];
    const int m = (full + wanted) / 2;
    const scene::LegendrePoints points(wanted, m);
    values[a] = scene::legendre_values(n[a], points.node);
    of_density[a] = scene::legendre_values(density_shape[a], points.node);
    analysis[a] = points.analysis;
    if (wanted > n[a])
      analysis[a] = scene::product(scene::chebyshev_truncation(n[a]).leftCols(wanted), points.analysis);
    points_[a] = m;
  }
  density_ = scene::along_axes(of_density[0], of_density[1], of_density[2], density, density_shape);
}

Eigen::VectorXd DensityProduct::operator()(const Eigen::VectorXd& field) const {
  const Eigen::VectorXd product = density_.cwiseProduct(
      scene::along_axes(matrices_.values[0], matrices_.values[1], matrices_.values[2], field, n_));
  return scene::along_axes(matrices_.analysis[0], matrices_.analysis[1], matrices_.analysis[2], product, points_);
}

LightAxes::LightAxes(const TensorShape& n, const Vec3& rate, const LightSolver& solver) {
  for (std::size_t a = 0; a < 3; ++a) {
    const double rate_here = rate[Eigen::Index(a)];
    along[a] = rate_here * scene::legendre_derivative(n[a]);
    weight[Eigen::Index(a)] = solver.closure == Closure::upwind ? std::abs(rate_here) : solver.weight * solver.weight;
    if (rate_here == 0) continue;
    end[a] = scene::legendre_values(n[a], Eigen::VectorXd::Constant(1, rate_here > 0 ? -1 : 1)).row(0);
    if (solver.closure == Closure::upwind) along[a] += std::abs(rate_here) * end[a] * end[a].transpose();
  }
}

LightSystem::LightSystem(const DensityProduct& product, const Vec3& rate, double sigma, const LightSolver& solver)
    : product_(product), rate_(rate), sigma_(sigma), solver_(solver), axes_(product.shape(), rate, solver) {
  const TensorShape& n = product.shape();
  const int unknowns = scene::tensor_size(n);
  if (solver.closure == Closure::least_squares && !solver.dense) throw Error("least squares are solved dense");
  if (solver.dense && unknowns > most_dense)
    throw Error(fmt::format("a dense system of {} unknowns, expected at most {}", unknowns, most_dense));
  if (!solver.dense) return;
  Eigen::MatrixXd equation(unknowns, unknowns);
  for (int k = 0; k < unknowns; ++k) equation.col(k) = apply(Eigen::VectorXd::Unit(unknowns, k));
  if (solver.closure == Closure::upwind) {
    factors_.emplace(equation);
    return;
  }
  equation_ = equation / rate.norm();
  Eigen::MatrixXd normal = scene::product(equation_.transpose(), equation_);
  for (int a = 0; a < 3; ++a) {
    const Eigen::VectorXd& end = axes_.end[std::size_t(a)];
    if (end.size() == 0) continue;
    const Eigen::MatrixXd rows = axes_.weight[a] * end * end.transpose();
    for (int k = 0; k < unknowns; ++k)
      normal.col(k) += scene::along_axis(a, rows, Eigen::VectorXd::Unit(unknowns, k), n);
  }
  normal_.emplace(normal);
}

Eigen::VectorXd LightSystem::apply(const Eigen::VectorXd& e) const {
  Eigen::VectorXd result = sigma_ * product_(e);
  for (std::size_t a = 0; a < 3; ++a)
    if (rate_[Eigen::Index(a)] != 0) result += scene::along_axis(int(a), axes_.along[a], e, product_.shape());
  return result;
}

// Right side for inflowing light: on a face a constant has one coefficient, twice its value.
Eigen::VectorXd LightSystem::inflow_side(double inflow) const {
  const TensorShape& n = product_.shape();
  Eigen::VectorXd side = Eigen::VectorXd::Zero(scene::tensor_size(n));
  for (int a = 0; a < 3; ++a) {
    const Eigen::VectorXd& end = axes_.end[std::size_t(a)];
    const Eigen::Index step = a == 0 ? n[1] * n[2] : a == 1 ? n[2] : 1;
    for (Eigen::Index k = 0; k < end.size(); ++k) side[k * step] += axes_.weight[a] * 2 * inflow * end[k];
  }
  return side;
}

Eigen::VectorXd LightSystem::solve(const Eigen::VectorXd& q, double inflow, int* iterations) const {
  const Eigen::VectorXd side = inflow_side(inflow);
  if (solver_.closure == Closure::least_squares) return normal_->solve(equation_.transpose() * q / rate_.norm() + side);
  if (solver_.dense) return factors_->solve(q + side);
  constexpr int most = 400;
  const GmresResult result =
      gmres([&](const Eigen::VectorXd& e) { return apply(e); }, q + side, solver_.tolerance, most);
  if (!(result.residual <= solver_.tolerance))
    throw Error(fmt::format("GMRES left a residual of {:.1e} after {} iterations, expected {:.1e}", result.residual,
                            result.iterations, solver_.tolerance));
  if (iterations) *iterations += result.iterations;
  return result.x;
}

}  // namespace airlight::legendre_fluids
