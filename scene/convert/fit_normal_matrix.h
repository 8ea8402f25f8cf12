// The normal matrix of a sum of Gaussians: for every pair that overlaps, the integrals of the products of their derivatives.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "scene/convert/separable_gaussians.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::scene {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

// Element (a, b): the integral over space of the product of d/da of Gaussian i and d/db of Gaussian j, variables in the order center x,
// y, z, width, amplitude; no cutoff. From the overlap G = (pi u v / (u + v))^(3/2) exp(-|d|^2 / (u + v)), u and v the squared widths, by
// differentiating it on both sides.
Matrix5 overlap_derivatives(const Gaussian& i, const Gaussian& j);

// Symmetric, of 5 x 5 blocks in single precision; those whose exponential is below 1e-3 are left out, but never one of the diagonal.
class NormalMatrix {
 public:
  // Runs in the arena of the caller, as multiply does.
  explicit NormalMatrix(const std::vector<Gaussian>&);

  std::size_t size() const { return begin_.size() - 1; }
  std::size_t blocks() const { return column_.size(); }
  const Matrix5& diagonal(std::size_t i) const { return diagonal_[i]; }
  // y = M x, five numbers a Gaussian.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

 private:
  std::vector<Matrix5> diagonal_;
  std::vector<std::size_t> begin_;  // of each row among those beside the diagonal
  std::vector<std::uint32_t> column_;
  separable::Aligned<float> block_;  // column by column, each padded to a vector
};

}  // namespace airlight::scene
