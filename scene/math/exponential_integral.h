// The exponential integral of a complex argument, scaled so that it neither overflows nor underflows.
#pragma once
#include <complex>

namespace airlight::scene {

// e^z E1(z) for Re z >= 0, z != 0 (NaN of NaN); E1(z) = integral over t in [z, infinity) of e^-t / t dt. Behaves as 1/z
// for large |z| and as -log z for small. Each of the real and imaginary parts is accurate to 1e-13 of itself, also next
// to the real axis (an imaginary part far below the real one keeps its digits). Abramowitz and Stegun 5.1.11
// and 5.1.22.
std::complex<double> scaled_exponential_integral(std::complex<double> z);

}  // namespace airlight::scene
