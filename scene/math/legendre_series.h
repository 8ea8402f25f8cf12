// Legendre series in one variable: coefficients of L_0, L_1, ... on [-1, 1].
#pragma once
#include <Eigen/Core>

namespace airlight::scene {

// Derivative and primitive of a series, like legendre_derivative and legendre_integral, without the matrices.
Eigen::VectorXd series_slope(const Eigen::VectorXd&);      // as many coefficients
Eigen::VectorXd series_primitive(const Eigen::VectorXd&);  // 0 at -1; one more

double series_value(const Eigen::VectorXd&, double x);

// On [-1, 0], or on [0, 1], as its own [-1, 1]. The matrices are kept by each thread.
Eigen::VectorXd series_half(const Eigen::VectorXd&, bool upper);

}  // namespace airlight::scene
