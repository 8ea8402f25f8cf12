// Polynomials on [0, 1] in Bernstein form: their range lies within their coefficients.
#pragma once
#include <array>

namespace airlight {

// sum_k coefficient[k] C(9, k) s^k (1 - s)^(9 - k).
inline constexpr int bernstein_size = 10;
using Bernstein = std::array<double, bernstein_size>;

// Chebyshev nodes in (0, 1), and the polynomial through values at them.
const Bernstein& bernstein_nodes();
Bernstein bernstein_through(const Bernstein& values);

// Integral of max(0, p) over [0, 1]: signs are isolated by subdivision, each piece of one sign is integrated exactly.
// Stops where what is left undecided is below `tolerance` (> 0, in units of the integral).
double integral_of_positive_part(const Bernstein&, double tolerance);

}  // namespace airlight
