// How the airlight around a point light spreads over the directions in which a surface receives it: the point spread
// function of Zhou et al. 2007, Eqs. 18 to 24, after Sun et al. 2005.
#pragma once
#include <vector>

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

// As a table, for loops over Gaussians at every pixel: values and slopes per step at u = 0, step, 2 step, ... up to
// AverageDepthNode::end, cubic between them to 1e-8 of the value; beyond it the asymptotic series, sqrt(pi)/(4 u^2) (1
// + w + 3 w^2 + 15 w^3 + ...) with w = 1/(2 u^2).
struct AverageDepthNode {
  static constexpr double end = 10;
  double value, slope;
};
const std::vector<AverageDepthNode>& average_depth_nodes();

}  // namespace airlight::fogshop
