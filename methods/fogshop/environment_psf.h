// How a medium of some optical depth spreads light over directions, as zonal harmonics by depth: what Zhou et al. 2007,
// Eqs. 18, 27 and 28, convolve an environment with.
#pragma once
#include <vector>

namespace airlight::fogshop {

// The light that a ball of homogeneous medium of radius T > 0 (in optical depths) scatters to its centre, at an angle
// gamma [rad, 0 to pi] from a distant source of parallel light, over T e^-T times its irradiance [1/sr]:
//   1/(4 pi T) integral over t in [0, T] of e^(T - t - s),  s = sqrt(T^2 - t^2 sin^2 gamma) - t cos gamma.
// Not in the paper. Its NPSF is that of a point light in the medium, whose light is denser close to it, so that it
// peaks as 1/gamma; an environment is infinitely far away, and its light enters everywhere alike. 1/(4 pi) at
// gamma = 0 and, for T -> 0, everywhere; nowhere more. Relative error 1e-7 for T up to 30.
double ball_psf(double gamma, double T);

// Its coefficient of the zonal harmonic of degree l >= 0, 2 pi integral ball_psf Y_l0 sin gamma dgamma. Error 1e-7 of
// that of degree 0.
double ball_psf_coefficient(int l, double T);

enum class Psf {
  npsf,           // Eq. 18: a point light at depth 1, for every depth
  npsf_by_depth,  // a point light at the depth at hand
  ball,           // a distant light around a ball of the depth at hand
};

// Coefficients g_l by depth, tabulated: 64 depths from 1e-3 to 30, even in log T, linear between them (2e-3), constant
// beyond; there the light itself is T times g or e^-30.
class PsfBands {
 public:
  PsfBands(Psf, int order);  // order >= 1

  std::vector<double> operator()(double T) const;  // g_l, l < order
  int order() const { return order_; }
  const std::vector<double>& values() const { return values_; }  // [depth][l]
  int depths() const { return int(values_.size()) / order_; }    // 1: the same for every depth

  static constexpr int entries = 64;
  static constexpr double least_depth = 1e-3, greatest_depth = 30;

 private:
  int order_;
  std::vector<double> values_;
};

}  // namespace airlight::fogshop
