#pragma once

// Products and decompositions of dense matrices. Eigen's templates take the compiler two to ten seconds in every file that names one; here
// each is compiled once. Sizes that do not fit are a mistake of the caller, and assert.

#include <Eigen/Core>
#include <memory>

namespace airlight::scene {

// The product A B. Arguments that are not stored matrices, such as a transposed one, are copied first.
Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b);

// Eigenvalues, ascending, and orthonormal eigenvectors, one a column.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricModes symmetric_modes(const Eigen::MatrixXd&);  // reads the lower triangle

// A square matrix in factors L U with partial pivoting. For a singular matrix, `solve` returns values
// that are not finite.
class SquareFactors {
 public:
  explicit SquareFactors(const Eigen::MatrixXd&);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

// A symmetric positive definite matrix in factors L L^T.
class DefiniteFactors {
 public:
  explicit DefiniteFactors(const Eigen::MatrixXd&);  // reads the lower triangle
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  Eigen::MatrixXd lower() const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

// Solves a symmetric positive definite system by factors L D L^T with pivots. Unlike DefiniteFactors it bears nearly singular matrices.
Eigen::MatrixXd solve_definite(const Eigen::MatrixXd&, const Eigen::MatrixXd& right);

// Any matrix: the solution of least squares that has the least norm.
class LeastNormFactors {
 public:
  // Pivots below `threshold` times the greatest count as zero; 0: rounding times the size.
  explicit LeastNormFactors(const Eigen::MatrixXd&, double threshold = 0);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  int rank() const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

Eigen::MatrixXd inverse(const Eigen::MatrixXd&);
// The solution of an upper triangular system; what lies below the diagonal is not read.
Eigen::MatrixXd solve_upper(const Eigen::MatrixXd&, const Eigen::MatrixXd& right);

}  // namespace airlight::scene
