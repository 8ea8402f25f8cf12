// Real spherical harmonics: orthonormal over the sphere, Condon-Shortley phase, index l(l+1)+m, polar axis z.
//
//   Y_lm = sqrt(2) K cos(m phi) P_l^m(cos theta) for m > 0,   K P_l^0 for m = 0,
//          sqrt(2) K sin(|m| phi) P_l^|m|(cos theta) for m < 0,   K^2 = (2l+1)/(4 pi) (l-|m|)!/(l+|m|)!
// with (-1)^m inside P_l^m, so Y_00 = 1/sqrt(4 pi) and Y_1,-1, Y_10, Y_11 = sqrt(3/(4 pi)) (-y, z, -x).
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

inline constexpr int max_sh_order = 64;

inline int sh_index(int l, int m) { return l * (l + 1) + m; }

// Writes the order^2 values of the bands 0 to order-1 for a unit direction. Absolute error about 1e-15 times the order.
// Throws Error unless 1 <= order <= max_sh_order.
void evaluate_sh(int order, const Vec3& direction, double* values);
std::vector<double> evaluate_sh(int order, const Vec3& direction);

// The function with these coefficients (a square number of them) at a unit direction.
Rgb evaluate_sh(const std::vector<Rgb>& coefficients, const Vec3& direction);

}  // namespace airlight::scene
