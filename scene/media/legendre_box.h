// Density as a polynomial in a box: coefficients of the orthonormal Legendre basis of scene/math/legendre.h, clamped at 0.
//
//   density(x) = max(0, sum F[i][j][k] L_i(u) L_j(v) L_k(w)),   (u, v, w) in [-1, 1]^3 over the box; 0 outside
//
// Gupta and Narasimhan 2007, section 4.
#pragma once
#include <memory>

#include "scene/math/legendre.h"
#include "scene/math/types.h"

namespace airlight::scene {

class LegendreBox {
 public:
  static constexpr int most = 32;  // coefficients along an axis, degree 31

  // `coefficients` [x][y][z] of `shape`, 1 to `most` along each axis, finite; the box has positive sides. Searches for the greatest density
  // (a moment at 32^3). Throws Error.
  LegendreBox(const Box&, const TensorShape& shape, Eigen::VectorXd coefficients);

  const Box& box() const { return box_; }
  const TensorShape& shape() const { return shape_; }
  const Eigen::VectorXd& coefficients() const { return coefficients_; }
  double greatest() const {
    return greatest_;
  }  // rigorous, a per cent too great where the search ended in time; 0 if negative everywhere
  bool negative() const { return negative_; }    // may it be below 0 anywhere, so that clamping matters
  double rounding() const { return rounding_; }  // of a value, absolute

  Point3 local(const Point3& x) const;      // from the world to [-1, 1]^3
  double value(const Point3& local) const;  // of the polynomial, not clamped

 private:
  Box box_;
  TensorShape shape_;
  Eigen::VectorXd coefficients_;
  double greatest_ = 0, rounding_ = 0;
  bool negative_ = false;
};

double density(const LegendreBox&, const Point3& x);                  // [-]
Interval density_bounds(const LegendreBox&, const Box&);              // rigorous, rounding counted
double density_integral(const LegendreBox&, const Ray&, Interval t);  // [m], exact to rounding, sign changes included
Interval extent(const LegendreBox&, const Ray&, Interval t);
Box support(const LegendreBox&);  // empty where it is negative everywhere

}  // namespace airlight::scene
