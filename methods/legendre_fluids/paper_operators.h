// The operators of the paper's section 5 as it prints them, without walls: n coefficients of L along each axis for every field.
// Lengths are half sizes of the box, as in ConfinedSpace.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

#include "methods/legendre_fluids/confined_space.h"
#include "scene/math/dense.h"

namespace airlight::legendre_fluids {

enum class Truncation { chebyshev, l2 };

// Number of equal parts of a step of dt [s] in which the series of equation 14 is summed, for a norm of A of about `rate` [1/s]. Throws
// scene::Unstable above 2e4, which flows that have blown up need.
int parts_of_advection(double dt, double rate);

// A of equation 13, A = T (sum over axes of D M_U), for one velocity: the derivative of all 2n-1 coefficients of each product, cut to n.
class PaperAdvection {
 public:
  PaperAdvection(int dimensions, int n, Truncation);
  // Sets U, one array per axis. The following operators advect with it.
  void set_velocity(const Components& u);
  Array operator()(const Array& c) const;  // A c
  // Equation 14, exp(-dt A) c with the right sign, by its series, since A need not have an eigenbasis. Throws scene::Unstable where the
  // velocity is so great that it has no end.
  Array advected(const Array& c, double dt) const;

  // Matrices along an axis, for other implementations: coefficients to values at the points; values of a product to its coefficients, cut
  // to n; values of a product to coefficients of its derivative, cut to n.
  struct Matrices {
    const Eigen::MatrixXd &values, &cut, &derived_and_cut;
  };
  Matrices matrices() const { return {values_, cut_, derived_and_cut_}; }

 private:
  Array along(const std::array<const Eigen::MatrixXd*, 3>&, const Array&, TensorShape) const;
  int d_, n_;
  Eigen::MatrixXd values_, cut_, derived_and_cut_;  // to the 2n-1 points, and back
  Components u_;                                    // at the points
  double rate_ = 0;                                 // what the norm of A is about [1/s]
};

// Equations 16, 19 and 20.
class PaperLaplacian {
 public:
  PaperLaplacian(int dimensions, int n, const Vec3& half);
  Array gradient(int axis, const Array& c) const;  // D_axis c
  Array operator()(const Array& c) const;          // D^2 c [1/m^2]
  // The solution of (1 - amount D^2) x = c, amount = viscosity dt [m^2]: D^2 is nilpotent, so the series ends. No walls: it amplifies.
  Array diffused(const Array& c, double amount) const;
  // U - D Q with D^2 Q = div U in the sense of least squares, Q of least norm. The first call decomposes a dense matrix of n^d rows.
  Components projected(const Components& u) const;
  int rank() const { return decomposition().rank(); }
  const Eigen::MatrixXd& derivative() const { return derivative_; }  // D along an axis
  // The matrix that takes a divergence to Q. Decomposes as projected() does.
  Eigen::MatrixXd least_norm_inverse() const;

 private:
  const scene::LeastNormFactors& decomposition() const;
  int d_, n_;
  Vec3 half_;
  TensorShape shape_;
  Eigen::MatrixXd derivative_;
  mutable std::optional<scene::LeastNormFactors> decomposition_;
};

}  // namespace airlight::legendre_fluids
