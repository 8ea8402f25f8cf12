// Functions given by real spherical harmonics (spherical_harmonics.h), turned in space.
//
// A rotation by Euler's angles is R = Rz(a) Ry(b) Rz(c) = Rz(a + pi) X Rz(b + pi) X Rz(c) with the quarter turn
// X = Rx(pi/2): turns about z mix the two harmonics of one |m|, and X is a sparse matrix that is the same for all R.
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

// X on the coefficients of `order` bands: row i holds the entries first[i] to first[i + 1] - 1, about a quarter of its
// band. Error 1e-15.
struct ShQuarterTurn {
  std::vector<int> first, column;
  std::vector<double> value;
};
// The quarter turn for this order. Computed on first use and cached; thread-safe. Throws Error unless 1 <= order <= 12.
const ShQuarterTurn& sh_quarter_turn(int order);

// Coefficients of g with g(R w) = f(w), R a rotation matrix. Absolute error about 1e-14 of the greatest coefficient.
// Throws Error for other numbers of coefficients than the square of an order of 1 to 12.
std::vector<Rgb> turned_sh(const std::vector<Rgb>& f, const Mat3& rotation);

}  // namespace airlight::scene
