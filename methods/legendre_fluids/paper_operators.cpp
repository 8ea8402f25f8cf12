#include "methods/legendre_fluids/paper_operators.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/flow/flow.h"
#include "scene/math/dense.h"

namespace airlight::legendre_fluids {

using Eigen::MatrixXd;
using scene::along_axis;
using scene::product;

namespace {

constexpr double most_parts = 2e4;

}  // namespace

int parts_of_advection(double dt, double rate) {
  const double parts = std::ceil(dt * rate);
  if (!(parts <= most_parts))
    throw scene::Unstable(
        fmt::format("advection at a rate of {:.3g} per second, too much for a step of {:g} s", rate, dt));
  return std::max(1, int(parts));
}

PaperAdvection::PaperAdvection(int dimensions, int n, Truncation truncation) : d_(dimensions), n_(n) {
  const int full = 2 * n - 1;  // coefficients of a product, and points that are exact for it
  const scene::LegendrePoints points(full, full);
  const MatrixXd cut =
      truncation == Truncation::chebyshev ? scene::chebyshev_truncation(n) : MatrixXd(MatrixXd::Identity(n, full));
  values_ = points.values.leftCols(n);
  cut_ = product(cut, points.analysis);
  derived_and_cut_ = product(product(cut, scene::legendre_derivative(full)), points.analysis);
}

Array PaperAdvection::along(const std::array<const MatrixXd*, 3>& matrix, const Array& c, TensorShape s) const {
  Array result = c;
  for (int a = 0; a < d_; ++a) {
    result = along_axis(a, *matrix[a], result, s);
    s[a] = int(matrix[a]->rows());
  }
  return result;
}

void PaperAdvection::set_velocity(const Components& u) {
  rate_ = 0;
  for (int a = 0; a < d_; ++a) {
    u_[a] = along({&values_, &values_, &values_}, u[a], {n_, n_, d_ == 3 ? n_ : 1});
    rate_ += u_[a].cwiseAbs().maxCoeff() * n_ * n_;
  }
}

Array PaperAdvection::operator()(const Array& c) const {
  const int full = 2 * n_ - 1;
  const TensorShape points{full, full, d_ == 3 ? full : 1};
  const Array at_points = along({&values_, &values_, &values_}, c, {n_, n_, d_ == 3 ? n_ : 1});
  Array sum = Array::Zero(c.size());
  for (int a = 0; a < d_; ++a) {
    std::array<const MatrixXd*, 3> matrix{&cut_, &cut_, &cut_};
    matrix[a] = &derived_and_cut_;
    sum += along(matrix, u_[a].cwiseProduct(at_points), points);
  }
  return sum;
}

Array PaperAdvection::advected(const Array& c, double dt) const {
  if (c.size() == 0) return c;
  const int count = parts_of_advection(dt, rate_);
  Array result = c;
  for (int part = 0; part < count; ++part) {
    Array term = result;
    const double small = 1e-17 * result.norm();
    for (int k = 1; k < 60 && term.norm() > small; ++k) {
      term = -dt / count / k * (*this)(term);
      result += term;
    }
  }
  return result;
}

PaperLaplacian::PaperLaplacian(int dimensions, int n, const Vec3& half)
    : d_(dimensions), n_(n), half_(half), shape_{n, n, d_ == 3 ? n : 1}, derivative_(scene::legendre_derivative(n)) {}

Array PaperLaplacian::gradient(int axis, const Array& c) const { return along_axis(axis, derivative_, c, shape_); }

Array PaperLaplacian::operator()(const Array& c) const {
  Array sum = Array::Zero(c.size());
  for (int a = 0; a < d_; ++a) sum += gradient(a, gradient(a, c)) / (half_[a] * half_[a]);
  return sum;
}

Array PaperLaplacian::diffused(const Array& c, double amount) const {
  Array result = c, term = c;
  // 1 + amount D^2 + (amount D^2)^2 + ...: each term is two degrees lower.
  for (int degree = d_ * (n_ - 1); degree >= 2; degree -= 2) {
    term = amount * (*this)(term);
    result += term;
  }
  return result;
}

const scene::LeastNormFactors& PaperLaplacian::decomposition() const {
  if (decomposition_) return *decomposition_;
  const int size = scene::tensor_size(shape_);
  MatrixXd matrix(size, size);
  for (int i = 0; i < size; ++i) matrix.col(i) = (*this)(Array::Unit(size, i));
  return decomposition_.emplace(matrix, 1e-11);  // what is smaller is the null space: D^2 is nilpotent
}

MatrixXd PaperLaplacian::least_norm_inverse() const {
  const int size = scene::tensor_size(shape_);
  return decomposition().solve(MatrixXd::Identity(size, size));
}

Components PaperLaplacian::projected(const Components& u) const {
  Array divergence = gradient(0, u[0]);
  for (int a = 1; a < d_; ++a) divergence += gradient(a, u[a]);
  const Array q = decomposition().solve(divergence);
  Components result;
  // A velocity's component is counted in halves of the box, and so is D: Eq. 20's gradient is D_a Q over half^2 in those units.
  for (int a = 0; a < d_; ++a) result[a] = u[a] - gradient(a, q) / (half_[a] * half_[a]);
  return result;
}

}  // namespace airlight::legendre_fluids
