// How the airlight around a point light spreads over the directions in which a surface receives it: the point spread
// function of Zhou et al. 2007, Eqs. 18 to 24, after Sun et al. 2005.
#pragma once
#include <array>

namespace airlight::fogshop {

// NPSF: the light that a homogeneous medium scatters into the direction at an angle gamma [rad, 0 to pi] from that of
// the light, by an optical depth T >= 0 away from it, over T e^-T times the unscattered irradiance [1/sr].
//   NPSF_T(gamma) = Im e^z E1(z) / (2 pi sin gamma),  z = T (1 - e^(i gamma))
// Eq. 18 is T = 1, its fixed form for every T; the difference reaches a factor of 2. Behaves as 1/(4 gamma) near 0
// (infinite at 0). Relative error 1e-13.
double npsf(double gamma, double T);

// Its coefficient of the zonal harmonic of degree l >= 0, g_l = 2 pi integral NPSF Y_l0 sin gamma dgamma: the numbers
// after Eq. 21, for any T. Relative error 1e-12.
double npsf_coefficient(int l, double T);

// Mean optical depth of a Gaussian around a point, over the directions from that point, where its centre is u widths
// away: c / a times this [-]. sqrt(pi)/2 D(u)/u with Dawson's integral D, the paper's table in closed form.
double average_depth(double u);

// D(u)/u for loops over Gaussians at every point: of w = u^2 up to `end` the quotient of two polynomials (of the
// denominator from the power 1 on, the first coefficient is 1), a minimax fit; beyond it the series o (1 + o + 3 o^2 + 15
// o^3 + ...) with o = 1/(2 w). Relative error 1.1e-9, no term negative.
struct DawsonFit {
  static constexpr double end = 1e3;
  static constexpr std::array<double, 10> numerator = {
      9.999999989557623e-01, 7.464124689114666e-02, 4.265108086531265e-02, 5.763826170027294e-03,
      8.238391861228267e-04, 8.954605078752411e-05, 7.392692268597690e-06, 7.415749272984226e-07,
      1.242839665557778e-08, 3.953943625724011e-09};
  static constexpr std::array<double, 10> denominator = {
      7.413078485587338e-01, 2.701903123064369e-01, 6.439637865529978e-02, 1.125923508571226e-02,
      1.528618842718418e-03, 1.712559093267873e-04, 1.401755214300180e-05, 1.466790333212743e-06,
      2.090279060204737e-08, 7.907887297411495e-09};
};

}  // namespace airlight::fogshop
