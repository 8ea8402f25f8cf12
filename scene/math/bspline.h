// Cardinal B-splines N_n of degree n = 0 to 3, support [0, n + 1): the sum over all shifts by integers is 1. Degree 0 is
// half-open. Giroud and Biri 2010, section 3, in forms without cancellation.
#pragma once
#include <type_traits>

namespace airlight::scene {

inline constexpr int most_spline_degree = 3;

// Values in a cell at the local position u in [0, 1]: value[m] belongs to the coefficient m places before the cell.
template <int n>
inline void cell_basis(double u, double (&value)[n + 1]) {
  static_assert(n >= 0 && n <= most_spline_degree);
  const double w = 1 - u;
  if constexpr (n == 0) {
    value[0] = 1;
  } else if constexpr (n == 1) {
    value[0] = u;
    value[1] = w;
  } else if constexpr (n == 2) {
    value[0] = 0.5 * u * u;
    value[1] = 0.5 + u * w;
    value[2] = 0.5 * w * w;
  } else {
    value[0] = u * u * u / 6;
    value[1] = (1 + 3 * u * (1 + u * w)) / 6;
    value[2] = (1 + 3 * w * (1 + u * w)) / 6;
    value[3] = w * w * w / 6;
  }
}

// N_n at u; n in 0 to 3.
double bspline(int n, double u);

// N_m at an integer, m >= 0 of any size.
double bspline_at_integer(int m, int k);

// Calls body with the degree as a constant: body(std::integral_constant<int, n>()).
template <class Body>
decltype(auto) with_degree(int n, Body&& body) {
  switch (n) {
    case 0:
      return body(std::integral_constant<int, 0>());
    case 1:
      return body(std::integral_constant<int, 1>());
    case 2:
      return body(std::integral_constant<int, 2>());
    default:
      return body(std::integral_constant<int, 3>());
  }
}

}  // namespace airlight::scene
