#include "methods/legendre_fluids/gmres.h"

#include <Eigen/Jacobi>
#include <vector>

#include "scene/math/dense.h"

namespace airlight::legendre_fluids {

GmresResult gmres(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& apply, const Eigen::VectorXd& right,
                  double tolerance, int most) {
  const double size = right.norm();
  GmresResult result{Eigen::VectorXd::Zero(right.size()), 0, 0};
  if (size == 0) return result;
  std::vector<Eigen::VectorXd> basis = {right / size};
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(most + 1, most);
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(most + 1);  // the right side, rotated with the triangle
  rest[0] = size;
  std::vector<Eigen::JacobiRotation<double>> rotations;
  int k = 0;
  for (result.residual = 1; k < most && result.residual > tolerance; ++k) {
    Eigen::VectorXd next = apply(basis.back());
    for (int twice = 0; twice < 2; ++twice)
      for (int i = 0; i <= k; ++i) {
        const double part = basis[std::size_t(i)].dot(next);
        triangle(i, k) += part;
        next -= part * basis[std::size_t(i)];
      }
    const double left = next.norm();
    triangle(k + 1, k) = left;
    for (int i = 0; i < k; ++i) triangle.col(k).applyOnTheLeft(i, i + 1, rotations[std::size_t(i)].adjoint());
    rotations.emplace_back();
    rotations.back().makeGivens(triangle(k, k), triangle(k + 1, k));
    triangle.col(k).applyOnTheLeft(k, k + 1, rotations.back().adjoint());
    rest.applyOnTheLeft(k, k + 1, rotations.back().adjoint());
    result.residual = std::abs(rest[k + 1]) / size;
    if (left > 0)
      basis.push_back(next / left);
    else
      result.residual = 0;
  }
  const Eigen::VectorXd weights = scene::solve_upper(triangle.topLeftCorner(k, k), rest.head(k));
  for (int i = 0; i < k; ++i) result.x += weights[i] * basis[std::size_t(i)];
  result.iterations = k;
  return result;
}

}  // namespace airlight::legendre_fluids
