// Where the values of a Legendre series lie, without missing any: on the whole of [-1, 1]^d, or on a part of it.
#pragma once
#include <functional>

#include "scene/math/legendre.h"
#include "scene/math/types.h"

namespace airlight::scene {

// Coefficients on [-1, 1] to those of the same polynomial on [lo, hi] as its own [-1, 1]: n x n, upper triangular. Well conditioned for
// [lo, hi] within [-1, 1].
Eigen::MatrixXd legendre_restriction(int n, double lo, double hi);

// Least and greatest are within: the hull of the Bernstein coefficients of the first eight degrees of every axis, widened by the greatest
// that the higher ones can add up to. The hull alone up to degree 7, where corner values are met exactly. Rounding is not counted: the
// caller knows how large the series was that this one is a part of. Axes from `dimensions` on are absent (length 1, no L_0).
Interval legendre_range(const Eigen::VectorXd& f, const TensorShape&, int dimensions = 3);
// Range of a series in one variable.
Interval legendre_range(const Eigen::VectorXd& series);

// Upper bound of |f|: sum of |coefficient| times the greatest value of its function.
double legendre_bound(const Eigen::VectorXd& f, const TensorShape&, int dimensions = 3);

// Where a series is greatest: at one place at least `found`, nowhere above `bound` but for rounding.
struct GreatestValue {
  double found, bound;
};
// Halves the part of [-1, 1]^3 that may hold it until that is `enough`, 400 times at most.
GreatestValue legendre_greatest(const Eigen::VectorXd& f, const TensorShape&,
                                const std::function<bool(const GreatestValue&)>& enough);

}  // namespace airlight::scene
