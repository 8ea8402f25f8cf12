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

 private:
  const scene::LeastNormFactors& decomposition() const;
  int d_, n_;
  Vec3 half_;
  TensorShape shape_;
  Eigen::MatrixXd derivative_;
  mutable std::optional<scene::LeastNormFactors> decomposition_;
};

}  // namespace airlight::legendre_fluids
