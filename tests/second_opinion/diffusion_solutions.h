// The diffusion equation where it has a solution in closed form: div(kappa grad L0) - (1 - albedo) sigma_t L0 + sigma_t J0 = 0,
// kappa = 1 / (3 sigma_tr), sigma_tr = (1 - albedo g) sigma_t. L0: mean radiance that has been scattered, J0: mean of the single source.
#pragma once
#include <cmath>

#include "scene/math/types.h"

namespace airlight::test {

struct Diffusion {
  double sigma_t, albedo, g = 0;
  double sigma_tr() const { return (1 - albedo * g) * sigma_t; }  // [1/m]
  double kappa() const { return 1 / (3 * sigma_tr()); }           // [m]
  double sigma_eff() const { return std::sqrt((1 - albedo) * sigma_t / kappa()); }

  // Mean radiance at a distance from an isotropic point source of this power, in infinite smoke.
  double around_point(double distance, double power) const {
    return power * std::exp(-sigma_eff() * distance) / (4 * pi * kappa() * distance) / (4 * pi);
  }
  // Mean radiance of an even source in infinite smoke.
  double of_even_source(double source) const { return source / (1 - albedo); }
  // Mean radiance at a depth in a slab between two vacua, with Marshak's condition -kappa dL0/dn = L0/2.
  double in_slab(double source, double thickness, double depth) const {
    const double s = sigma_eff(), half = 0.5 * s * thickness;
    return of_even_source(source) *
           (1 - std::cosh(s * depth - half) / (std::cosh(half) + 2 * kappa() * s * std::sinh(half)));
  }
};

}  // namespace airlight::test
