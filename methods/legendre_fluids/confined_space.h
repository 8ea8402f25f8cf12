// Velocities without flow through the walls of a box, and scalars in the same box, as polynomials: one Raviart-Thomas element.
//
//   phi_i(x) = integral of L_i from -1 to x, i = 1 .. n-1: 0 at both ends, phi_i' = L_i
//   u_x = sum a_ijk phi_i(x) L_j(y) L_k(z), and so on;   r = sum r_ijk L_i(x) L_j(y) L_k(z)
//
// The box is mapped to [-1, 1]^d, d = 2 or 3. Velocities are in half sizes of the box per second: the
// divergence is then a sum of coefficients of equal index, for any box. A velocity is one vector: its
// components one after the other, each [x][y][z] with the shape shape(). Gupta and Narasimhan 2007 have
// no such space (their equations 13 to 20 do not treat walls).
#pragma once
#include <array>
#include <functional>

#include "methods/legendre_fluids/advection_kernel.h"
#include "scene/math/legendre.h"
#include "scene/math/types.h"

namespace airlight::legendre_fluids {

using scene::TensorShape;
using Array = Eigen::VectorXd;
using Components = std::array<Array, 3>;  // one array per axis of the box; empty where there is no such axis

class ConfinedSpace {
 public:
  // n >= 1 coefficients along each axis (n = 1: no velocity), half sizes of the box [m].
  ConfinedSpace(int dimensions, int n, const Vec3& half = Vec3::Ones());

  int dimensions() const { return d_; }
  int n() const { return n_; }
  const Vec3& half() const { return half_; }
  int size() const { return offset_[d_]; }                     // of a velocity
  int scalars() const { return scene::tensor_size(shape()); }  // of a scalar
  TensorShape shape() const;                                   // of a scalar
  TensorShape shape(int component) const;
  Array component(const Array& u, int a) const { return u.segment(offset_[a], offset_[a + 1] - offset_[a]); }
  Array joined(const Components&) const;

  // Coefficients of div u [1/s]: exact.
  Array divergence(const Array& u) const;
  // The nearest velocity without divergence: orthogonal in the inner product below, exact to rounding.
  Array project(const Array& u) const;
  // Inner product over the box in world units: sum over components of the integral of u_a v_a [m^(d+2)/s^2]. inner(u,
  // u) / 2 is the energy.
  double inner(const Array& u, const Array& v) const;
  // The velocity w with inner(w, v) = the sum of w_a h_a^2 v_a for all v: M u, weighted.
  Array weighted(const Array& u) const;

  enum class Diffusion { exact, backward_euler };
  // After u_t = viscosity lap u over a time, amount their product [m^2]; walls are free-slip. Contracts for every amount >= 0.
  // Divergence is left to project().
  Array diffused(const Array& u, double amount, Diffusion = Diffusion::exact) const;
  Array scalar_diffused(const Array& r, double amount, Diffusion = Diffusion::exact) const;  // no flux through walls

  // At ceil(3n/2) Gauss points per axis, with which every product below is integrated exactly.
  Components at_points(const Array& u) const;
  Array scalar_at_points(const Array& r) const;
  const Array& nodes() const { return points_.node; }  // along an axis, the second half the first one's mirror image
  const Array& weights() const { return points_.weight; }
  const Eigen::MatrixXd& phi() const { return phi_; }  // coefficients of phi in L: (n+1) x (n-1)
  // Matrices of the operators, for other implementations: pairs are for L and for phi. n > 1.
  struct Matrices {
    const scene::LegendrePoints& points;  // of n + 1 coefficients
    const std::array<Eigen::MatrixXd, 2>&at_points, &from_points;
    const Eigen::MatrixXd &pressure_modes, &wall_modes, &free_modes, &from_scalar;
    const Array &wall_rates, &free_rates;
  };
  Matrices matrices() const {
    return {points_,     at_points_,   from_points_, pressure_modes_, wall_modes_,
            free_modes_, from_scalar_, wall_rates_,  free_rates_};
  }
  TensorShape points_shape() const;
  double integral(const Array& values) const;                 // over the box [m^d]
  Array scalar_from_points(const Array& values) const;        // L2 projection
  Array from_points(const Components& values) const;          // L2 projection of a velocity, before project()
  Array advected(const Components& w, const Array& u) const;  // -w.grad u, projected in L2 but not onto div = 0
  Array scalar_advected(const Components& w, const Array& r) const;
  // Both at once, of a velocity that carries itself and scalars, beside a wind at the points (empty: none): rates one after the other. A
  // velocity that does not move carries (its rate is 0).
  void advected_together(const double* u, bool moves, const Components& wind, const std::vector<const double*>& scalars,
                         double* u_rate, const std::vector<double*>& rates) const;
  // Rate of inflow through the side of an axis (0: low, 1: high) with a weak condition: (w.n)(r - r_in)
  // where w.n < 0. `speed` is w along the axis [half sizes per second] at the Gauss points of the side.
  // Added to the above, |r| cannot grow for r_in = 0.
  Array scalar_inflow(int axis, int side, const Array& speed, const Array& r, double r_in) const;
  // L2 projection of a velocity whose components are given as scalars: forces.
  Array from_scalars(const Components& scalars) const;

  // L2 projection by quadrature of functions of the reference box [-1, 1]^d; the velocity one in half sizes per second.
  Array from_function(const std::function<Vec3(const Vec3&)>& u) const;
  // With `points` of an axis; 0: enough for what is smooth.
  Array scalar_from_function(const std::function<double(const Vec3&)>& r, int points = 0) const;

  // On a lattice of points of the reference box, one list of positions per axis, [x][y][z].
  Array sampled(const Array& u, int component, const Components& positions) const;
  // Its gradient along an axis, over half sizes.
  Array sampled_gradient(const Array& u, int component, int axis, const Components& positions) const;
  Array scalar_sampled(const Array& r, const Components& positions) const;
  Array scalar_sampled_gradient(const Array& r, int axis, const Components& positions) const;

 private:
  Array transformed(const Array&, TensorShape, const std::array<const Eigen::MatrixXd*, 3>&) const;
  Array sampled(const Array& c, int component, int gradient_axis, const Components& positions) const;
  Array diffused_part(const Array&, int component, double amount, Diffusion) const;

  int d_, n_;
  Vec3 half_;
  std::array<int, 4> offset_{};
  scene::LegendrePoints points_;             // of n + 1 coefficients: the degree of phi
  Eigen::MatrixXd phi_;                      // coefficients of phi in L: (n+1) x (n-1)
  Eigen::MatrixXd mass_, inverse_;           // of phi; its inverse
  Eigen::MatrixXd wall_modes_, free_modes_;  // orthogonal: of the mass, n-1; of D^T D, n
  Array wall_rates_, free_rates_;            // the eigenvalues of -d^2/dx^2 along phi and along L
  Eigen::MatrixXd pressure_modes_;           // 1 and the wall modes: n
  Eigen::MatrixXd to_wall_modes_, to_free_modes_, to_pressure_modes_;
  Eigen::MatrixXd lifted_;  // inverse mass times what modes of pressure have from index 1 on
  Array pressure_;          // of a divergence, in modes
  std::array<Eigen::MatrixXd, 2> at_points_, slope_at_points_, from_points_;  // [0] L, [1] phi
  AdvectionKernel kernel_;
  Eigen::MatrixXd from_scalar_;  // L to phi, L2 projection
};

}  // namespace airlight::legendre_fluids
