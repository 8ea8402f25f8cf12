// One Gaussian seen along a ray, and sums of them: closed forms for what a ray needs.
//
// Along the ray a Gaussian is peak * exp(-a^2 (t - middle)^2), with a = 1/width. Zhou et al. 2007, Eq. 31, rewritten so
// that nothing cancels.
#pragma once
#include "scene/media/gaussian_sum.h"

namespace airlight::scene {

struct GaussianLine {
  double a;          // [1/m] 1 / width
  double middle;     // [m] ray parameter nearest to the centre
  double exponent;   // [-] squared distance of the line from the centre, in widths
  double amplitude;  // [-] at the centre

  // Integral over t [m], ends may be infinite.
  double integral(Interval t) const;
  // The part of t within `cutoff` widths of the centre.
  Interval clip(double cutoff, Interval t) const;
};

GaussianLine gaussian_line(const Gaussian&, const Ray&);

// Integral of max(0, f) over t for a sum with negative amplitudes [m]: the roots of f are isolated by interval bounds
// of f and its derivative, and each piece where f > 0 is integrated in closed form. Absolute error 1e-14 of the
// integral of the sum of |terms|.
double clamped_line_integral(const GaussianSum&, const Ray&, Interval t);

}  // namespace airlight::scene
