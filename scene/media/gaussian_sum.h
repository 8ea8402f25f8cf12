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

// max(0, f) at x [-].
double density(const GaussianSum&, const Point3& x);

// Least and greatest density over a box; rigorous, rounded outwards.
Interval density_bounds(const GaussianSum&, const Box&);

// Integral of the density over t in [t0, t1] of the ray [m], t1 may be infinite. Relative error 1e-14 where every
// amplitude is positive: Zhou et al. 2007, Eq. 31, in the forms that do not cancel.
double density_integral(const GaussianSum&, const Ray&, Interval t);

// Integral of one Gaussian over [0, d] of the ray [m]; spec/fogshop.md section 2. No cutoff.
double line_integral(const Gaussian&, const Ray&, double d);

// The box outside which the Gaussians (not the constant) are below 1e-17 of their amplitude, or the cutoff box.
Box support(const GaussianSum&);

}  // namespace airlight::scene
