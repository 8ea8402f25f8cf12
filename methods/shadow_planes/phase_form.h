// Phase functions as Biri et al. 2006 use them: mean 1 over the sphere (4 pi times scene/phase.h), in the variable q of
// a ray.
//
// On a ray that passes a light at distance h, theta is the angle at the light from the foot point, positive along the
// ray; q = tan(pi/4 + theta/2), and light that is scattered into the ray turns by the cosine c = -sin(theta)
// = (1 - q^2)/(1 + q^2).
#pragma once
#include <cmath>

#include "scene/phase.h"

namespace airlight::shadow_planes {

struct PhaseForm {
  enum class Kind { isotropic, rayleigh, hazy, murky, henyey_greenstein };
  Kind kind = Kind::isotropic;
  double g = 0;
  double scale = 1;  // hazy 1/2, murky 33/83; 1 as printed, which sends out more than comes in

  // Where the function changes, in q: the scale that a rule over q has to resolve.
  double width() const;
};
// `printed`: hazy and murky without their factors, means 2 and 83/33.
PhaseForm phase_form(const scene::PhaseFunction&, bool printed = false);

// v = (1+c)/2 = 1/(1+q^2), w = (1-c)/2 = 1 - v, both given because each loses its digits where the other is near 1.
template <class Real>
Real phase_of_halves(const PhaseForm& phase, Real v, Real w) {
  using std::sqrt;
  const auto eighth = [](Real x) { return x *= x, x *= x, x * x; };
  switch (phase.kind) {
    case PhaseForm::Kind::isotropic:
      return 1;
    case PhaseForm::Kind::rayleigh:
      return Real(0.75) * (1 + (v - w) * (v - w));
    case PhaseForm::Kind::hazy:
      return Real(phase.scale) * (1 + 9 * eighth(v));
    case PhaseForm::Kind::murky: {
      const Real v8 = eighth(v), v16 = v8 * v8;
      return Real(phase.scale) * (1 + 50 * v16 * v16);
    }
    case PhaseForm::Kind::henyey_greenstein: {
      const Real g = Real(phase.g);
      const Real d = g > 0 ? (1 - g) * (1 - g) + 4 * g * w : (1 + g) * (1 + g) - 4 * g * v;  // 1 + g^2 - 2 g c
      return (1 - g) * (1 + g) / (d * sqrt(d));
    }
  }
  return 0;
}

}  // namespace airlight::shadow_planes
