// Values of Legendre series in three variables at eight points at once: the same bits by AVX2 and by AVX-512, whatever stands in other lanes.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "scene/math/legendre.h"
#include "scene/math/types.h"

namespace airlight::legendre_fluids {

constexpr int lanes = 8;
using Lanes = Eigen::Array<double, lanes, 1>;

// The series of that shape (at most 96 coefficients along an axis) at the points (x, y, z).
Lanes series_values(const scene::TensorShape&, const double* coefficients, const Lanes& x, const Lanes& y,
                    const Lanes& z);
Eigen::VectorXd series_values(const scene::TensorShape&, const double* coefficients, const std::vector<Vec3>& points);
// At one point.
double series_value(const scene::TensorShape&, const double* coefficients, const Vec3& x);

}  // namespace airlight::legendre_fluids
