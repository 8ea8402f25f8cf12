// Density as a sum of isotropic Gaussians over a constant:
//   density(x) = constant + sum_i amplitude_i exp(-|x - center_i|^2 / width_i^2)
// Zhou et al. 2007, Eqs. 6 and 7, with a_i = 1/width_i, c_i = amplitude_i.
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

struct Gaussian {
  Point3 center = Point3::Zero();  // [m]
  double width = 1;                // [m], > 0: the distance at which the density falls to 1/e
  double amplitude = 1;            // [-], times the medium's extinction gives 1/m; may be negative
};

struct GaussianSum {
  std::vector<Gaussian> gaussians;
  double constant = 0;       // [-], >= 0
  double cutoff = infinity;  // [widths], > 0: beyond it a Gaussian is 0 (the jump is part of the definition)
};

// max(0, f) at x [-]. Cost: 2 ns per Gaussian.
double density(const GaussianSum&, const Point3& x);

// Least and greatest density over a box; rigorous, rounded outwards.
Interval density_bounds(const GaussianSum&, const Box&);

// Integral of the density over t in [t0, t1] of the ray [m]; ends may be infinite, and the answer then too if there is
// a constant. Inside the cutoff only. Zhou et al. 2007, Eq. 31, in the forms that do not cancel: relative error 1e-15
// (1 + E + D sqrt(E)) per Gaussian, where exp(-E) is its largest value on the way relative to its amplitude and D its
// distance in widths from the ray's origin (that is the rounding of the input). With negative amplitudes max(0, f) is
// integrated between its zeros, to 1e-13 of the integral of the sum of |terms|, at some fifty times the cost.
double density_integral(const GaussianSum&, const Ray&, Interval t);

// Integral of one Gaussian over [0, d] of the ray [m], d may be infinite. No cutoff, and no clamping.
double line_integral(const Gaussian&, const Ray&, double d);

// The part of t outside which every Gaussian is below 1e-17 of its amplitude, or cut off; all of t if there is a
// constant.
Interval extent(const GaussianSum&, const Ray&, Interval t);

// The box outside which the Gaussians (not the constant) are below 1e-17 of their amplitude, or the cutoff box.
Box support(const GaussianSum&);

}  // namespace airlight::scene
