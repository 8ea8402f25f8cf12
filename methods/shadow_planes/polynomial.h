// A point light's airlight as the paper evaluates it (Biri et al. 2006, Eq. 2, section 4.1 and annex):
//   L = albedo k / (4 pi h) e^(-k T) I  integral of e^(-a q(theta)) p(-sin theta) d theta, a = k h, q = tan(pi/4 + theta/2),
// k: extinction, h: distance of the light from the ray. The integrand's Taylor polynomial in theta, of any degree about any centre, is
// integrated term by term; mapped_rule.h integrates the same by a rule.
//
// It converges within pi/2 of theta = 0 and needs exp(a |theta|) times the digits of the result: useful for
// a = extinction * h up to about 3 and away from +-pi/2.
#pragma once
#include <vector>

#include "methods/shadow_planes/phase_form.h"

namespace airlight::shadow_planes {

// c_n e^(a q(centre)), n <= degree, of e^(-a q(theta)) p(-sin theta) = sum c_n (theta - centre)^n, |centre| < pi/2. By
// recurrences, exact.
std::vector<double> taylor_coefficients(const PhaseForm&, double a, int degree, double centre = 0);

// Coefficients for e^(-a tan(theta)) p, the paper's form in a bounded medium (section 4.2), times e^(a tan(centre)).
std::vector<double> bounded_coefficients(const PhaseForm&, double a, int degree, double centre = 0);

// The annex's, centre 0, with its errors: isotropic to degree 4, Rayleigh, hazy and murky to degree 2. `phase` is
// printed. Throws Error for Henyey-Greenstein, which it has not.
std::vector<double> printed_coefficients(const PhaseForm&, double a);

// taylor_coefficients (`bounded`: bounded_coefficients) and printed_coefficients, about theta = 0: each coefficient is a polynomial in a of its
// own, [n][power of a], for many values of a.
std::vector<std::vector<double>> coefficients_in_a(const PhaseForm&, int degree, bool bounded = false);
std::vector<std::vector<double>> printed_in_a(const PhaseForm&);

// Integral of the polynomial over theta in [theta0, theta1].
double integrate_polynomial(const std::vector<double>& coefficients, double centre, double theta0, double theta1);

// L [W/m^2/sr] of an isotropic intensity [W/sr] over the angles [theta0, theta1] at the light, Eq. 2. T, h as
// LightFromRay; h > 0.
double polynomial_airlight(const std::vector<double>& coefficients, double centre, double extinction, double albedo,
                           double intensity, double T, double h, double theta0, double theta1);

}  // namespace airlight::shadow_planes
