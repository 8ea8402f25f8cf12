// A smooth function in a cube as a polynomial of total degree 5, made from its values at points of the cube.
#pragma once
#include <array>
#include <vector>

#include "scene/math/types.h"

namespace airlight::fogshop {

struct CellPolynomial {
  static constexpr int degree = 5;
  static constexpr int size = (degree + 1) * (degree + 2) * (degree + 3) / 6;  // coefficients
  static constexpr int points = (degree + 1) * (degree + 1) * (degree + 1);    // what it is made from

  // Coefficients of x^a y^b z^c, a + b + c <= degree; c runs fastest, then b.
  std::array<double, size> coefficients{};

  // Value at a point of the cube [-1, 1]^3, or slightly outside.
  double operator()(const Vec3& place) const;
};

// Places in [-1, 1]^3: zeros of Chebyshev's polynomials along every axis.
const std::vector<Vec3>& cell_points();

// Chebyshev series, up to the total degree, of values at cell_points(). Polynomials of at most this
// degree are reproduced.
CellPolynomial fit_cell(const std::vector<double>& values);

}  // namespace airlight::fogshop
