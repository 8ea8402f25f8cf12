// The Faddeeva function w(z) = exp(-z^2) erfc(-i z) of a complex argument.
#pragma once
#include <complex>

namespace airlight::scene {

// For Im z >= 0, where |w| <= 1. Real and imaginary part each to 1e-12 of itself, but absolutely to 1e-15 where one of
// them vanishes (close to the axes, and the real part for real z beyond 10, where it is exp(-z^2) and 0 is returned).
// Weideman 1994, "Computation of the complex error function", and Laplace's continued fraction for |z| > 8.
std::complex<double> faddeeva(std::complex<double> z);

}  // namespace airlight::scene
