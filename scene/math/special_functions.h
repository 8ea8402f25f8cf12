// Special functions that the standard library lacks, and differences of exponentials that do not cancel.
#pragma once

namespace airlight {

// Scaled complementary error function exp(x^2) erfc(x). Relative error 2e-15 for all x; +inf below -26.6, 0 at +inf.
double erfcx(double x);

// Dawson's integral D(x) = exp(-x^2) times the integral of exp(t^2) over t in [0, x]; odd, about 1/(2x) far out.
// Relative error 1e-14.
double dawson(double x);

// (1 - exp(-x)) / x, 1 at x = 0: the mean of exp(-s) over s in [0, x]. Any finite x, and +inf (0).
double mean_exp_minus(double x);

// Integral of exp(-(a + (b - a) s)) over s in [0, 1] = (exp(-a) - exp(-b)) / (b - a), exp(-a) at b = a: the mean of the
// transmittance where the optical depth goes from a to b linearly. Relative error 1e-15 (1 + max(|a|, |b|)).
double mean_transmittance(double a, double b);

}  // namespace airlight
