#include "methods/compensated_ray_marching/diffusion_system.h"

#include <cmath>

#include "scene/base/error.h"

namespace airlight::compensated_ray_marching {
namespace {

// A function, its gradient and its Laplacian at a point.
struct Derivatives {
  double value = 0, laplacian = 0;
  Vec3 gradient = Vec3::Zero();
};

Derivatives at(const scene::Gaussian& g, const Point3& x) {
  const Vec3 offset = x - g.center;
  const double square = g.width * g.width, value = g.amplitude * std::exp(-offset.squaredNorm() / square);
  return {value, value * (4 * offset.squaredNorm() / square - 6) / square, -2 / square * value * offset};
}

}  // namespace

LinearSource linear_source(const double* f) {
  const double c = std::sqrt(3 / (4 * pi));
  return {f[0] / std::sqrt(4 * pi), c * Vec3(-f[3], -f[1], f[2])};
}

DiffusionSystem diffusion_system(const std::vector<scene::Gaussian>& gaussians,
                                 const std::vector<LinearSource>& sources, double sigma_t, double albedo, double g,
                                 DiffusionForm form) {
  const bool printed = form == DiffusionForm::as_printed;
  if (printed && !(albedo > 0)) throw Error("the printed diffusion equation divides by the albedo, found 0");
  const auto n = Eigen::Index(gaussians.size());
  const double sigma_tr = (1 - albedo * g) * sigma_t;
  DiffusionSystem system{Eigen::MatrixXd(n, n), Eigen::VectorXd(n)};
  std::vector<Derivatives> parts(gaussians.size());
  for (Eigen::Index h = 0; h < n; ++h) {
    const Point3& x = gaussians[std::size_t(h)].center;
    Derivatives all;
    for (std::size_t l = 0; l < gaussians.size(); ++l) {
      parts[l] = at(gaussians[l], x);
      all.value += parts[l].value;
      all.gradient += parts[l].gradient;
      all.laplacian += parts[l].laplacian;
    }
    const double D = all.value, kappa = 1 / (3 * sigma_tr * D);
    double mean = 0, divergence = 0;
    for (Eigen::Index l = 0; l < n; ++l) {
      // The share of Gaussian l in all of them.
      const Derivatives& q = parts[std::size_t(l)];
      const double share = q.value / D;
      const Vec3 gradient = (q.gradient - share * all.gradient) / D;
      const double laplacian = (q.laplacian - share * all.laplacian - 2 * gradient.dot(all.gradient)) / D;
      // Multiplied out: the left side of Eq. 13, with grad kappa = -kappa grad D / D. A third of the paper's mu-bar is g.
      system.matrix(h, l) = kappa * (laplacian - gradient.dot(all.gradient) / D) - (1 - albedo) * sigma_t * D * share;
      mean += share * sources[std::size_t(l)].mean;
      divergence += gradient.dot(sources[std::size_t(l)].direction);
    }
    system.right[h] = printed ? -sigma_t / albedo * D * mean + sigma_t / sigma_tr * divergence
                              : -sigma_t * D * mean + sigma_t / (3 * sigma_tr) * divergence;
  }
  return system;
}

std::vector<LinearSource> scattered_radiance(const std::vector<scene::Gaussian>& gaussians,
                                             const std::vector<LinearSource>& sources, const Eigen::VectorXd& mean,
                                             double sigma_t, double albedo, double g, DiffusionForm form) {
  const double factor = (form == DiffusionForm::as_printed ? 1 : 3) / (3 * (1 - albedo * g) * sigma_t);
  std::vector<LinearSource> radiance(gaussians.size());
  for (std::size_t h = 0; h < gaussians.size(); ++h) {
    double D = 0;
    Vec3 gradient = Vec3::Zero(), weighted = Vec3::Zero(), direction = Vec3::Zero();
    for (std::size_t l = 0; l < gaussians.size(); ++l) {
      const Derivatives q = at(gaussians[l], gaussians[h].center);
      D += q.value;
      gradient += q.gradient;
      weighted += mean[Eigen::Index(l)] * q.gradient;
      direction += q.value * sources[l].direction;
    }
    double here = 0;
    for (std::size_t l = 0; l < gaussians.size(); ++l)
      here += at(gaussians[l], gaussians[h].center).value / D * mean[Eigen::Index(l)];
    radiance[h] = {mean[Eigen::Index(h)], factor / D * (-(weighted - here * gradient) / D + sigma_t * direction)};
  }
  return radiance;
}

namespace {

struct Matrix {
  const Eigen::MatrixXd& rows;
  Eigen::VectorXd scale;
  Eigen::VectorXd times(const Eigen::VectorXd& x) const { return scale.cwiseProduct(rows * x); }
  Eigen::VectorXd transposed(const Eigen::VectorXd& y) const { return rows.transpose() * scale.cwiseProduct(y); }
};

// `residual`: of the start. `whole`: what the result's residual is relative to.
LeastSquares conjugate_gradients(const Matrix& a, Eigen::VectorXd residual, LeastSquares result, int iterations,
                                 double tolerance, double whole) {
  Eigen::VectorXd gradient = a.transposed(residual), direction = gradient;
  double square = gradient.squaredNorm();
  while (result.iterations < iterations && std::sqrt(square) > tolerance * whole) {
    const Eigen::VectorXd along = a.times(direction);
    const double length = along.squaredNorm();
    if (!(length > 0)) break;
    const double step = square / length;
    result.x += step * direction;
    residual -= step * along;
    gradient = a.transposed(residual);
    const double next = gradient.squaredNorm();
    direction = gradient + next / square * direction;
    square = next;
    ++result.iterations;
  }
  result.residual = std::sqrt(square) / whole;
  return result;
}

// The length of y, which is made to be 1 unless it is 0.
double taken_length(Eigen::VectorXd& y) {
  const double length = y.norm();
  if (length > 0) y /= length;
  return length;
}

// A V = U B with B lower bidiagonal (diagonal alpha, below it beta); its rotations to an upper one give x step by step.
LeastSquares lsqr(const Matrix& a, Eigen::VectorXd residual, LeastSquares result, int iterations, double tolerance,
                  double whole) {
  Eigen::VectorXd& u = residual;
  double left = taken_length(u);
  Eigen::VectorXd v = a.transposed(u);
  double alpha = taken_length(v), diagonal = alpha, gradient = alpha * left;
  Eigen::VectorXd direction = v;
  while (result.iterations < iterations && gradient > tolerance * whole) {
    u = a.times(v) - alpha * u;
    const double beta = taken_length(u);
    v = a.transposed(u) - beta * v;
    alpha = taken_length(v);
    const double length = std::hypot(diagonal, beta), cosine = diagonal / length, sine = beta / length;
    result.x += cosine * left / length * direction;
    direction = v - sine * alpha / length * direction;
    left *= sine;
    diagonal = -cosine * alpha;
    gradient = left * alpha * std::abs(cosine);
    ++result.iterations;
  }
  result.residual = gradient / whole;
  return result;
}

}  // namespace

LeastSquares solve_least_squares(const DiffusionSystem& system, const Eigen::VectorXd& start, int iterations,
                                 double tolerance, LeastSquaresSolver solver) {
  Matrix a{system.matrix, Eigen::VectorXd::Ones(system.right.size())};
  if (solver == LeastSquaresSolver::cg_scaled || solver == LeastSquaresSolver::lsqr_scaled)
    for (Eigen::Index h = 0; h < a.scale.size(); ++h)
      if (const double length = system.matrix.row(h).norm(); length > 0) a.scale[h] = 1 / length;
  const Eigen::VectorXd right = a.scale.cwiseProduct(system.right);
  const double all = a.transposed(right).norm(), whole = all > 0 ? all : 1;
  const bool is_lsqr = solver == LeastSquaresSolver::lsqr || solver == LeastSquaresSolver::lsqr_scaled;
  return (is_lsqr ? lsqr : conjugate_gradients)(a, right - a.times(start), {start}, iterations, tolerance, whole);
}

}  // namespace airlight::compensated_ray_marching
