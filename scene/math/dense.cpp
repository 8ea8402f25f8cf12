#include "scene/math/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace airlight::scene {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd product(const Eigen::Ref<const MatrixXd>& a, const Eigen::Ref<const MatrixXd>& b) { return a * b; }

SymmetricModes symmetric_modes(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

struct SquareFactors::Factors : Eigen::PartialPivLU<MatrixXd> {
  using PartialPivLU::PartialPivLU;
};
SquareFactors::SquareFactors(const MatrixXd& matrix) : factors_(std::make_shared<Factors>(matrix)) {}
MatrixXd SquareFactors::solve(const MatrixXd& right) const { return factors_->solve(right); }

struct DefiniteFactors::Factors : Eigen::LLT<MatrixXd> {
  using LLT::LLT;
};
DefiniteFactors::DefiniteFactors(const MatrixXd& matrix) : factors_(std::make_shared<Factors>(matrix)) {}
MatrixXd DefiniteFactors::solve(const MatrixXd& right) const { return factors_->solve(right); }
MatrixXd DefiniteFactors::lower() const { return factors_->matrixL(); }

MatrixXd solve_definite(const MatrixXd& matrix, const MatrixXd& right) {
  return Eigen::LDLT<MatrixXd>(matrix).solve(right);
}

struct LeastNormFactors::Factors : Eigen::CompleteOrthogonalDecomposition<MatrixXd> {};
LeastNormFactors::LeastNormFactors(const MatrixXd& matrix, double threshold) {
  const auto factors = std::make_shared<Factors>();
  if (threshold > 0) factors->setThreshold(threshold);
  factors->compute(matrix);
  factors_ = factors;
}
MatrixXd LeastNormFactors::solve(const MatrixXd& right) const { return factors_->solve(right); }
int LeastNormFactors::rank() const { return int(factors_->rank()); }

MatrixXd inverse(const MatrixXd& matrix) { return matrix.inverse(); }
MatrixXd solve_upper(const MatrixXd& matrix, const MatrixXd& right) {
  return matrix.triangularView<Eigen::Upper>().solve(right);
}

}  // namespace airlight::scene
