#include "methods/shadow_planes/phase_form.h"

#include "scene/base/kinds.h"

namespace airlight::shadow_planes {

double PhaseForm::width() const {
  switch (kind) {
    case Kind::hazy:
      return 0.5;
    case Kind::murky:
      return 0.25;
    case Kind::henyey_greenstein:
      return g > 0 ? (1 - g) / (1 + g) : 1;
    default:
      return 1;
  }
}

PhaseForm phase_form(const scene::PhaseFunction& phase, bool printed) {
  using Kind = PhaseForm::Kind;
  return scene::match(
      phase, [](scene::Isotropic) { return PhaseForm{}; },
      [](scene::Rayleigh) {
        return PhaseForm{Kind::rayleigh, 0, 1};
      },
      [](scene::HenyeyGreenstein hg) {
        return PhaseForm{Kind::henyey_greenstein, hg.g, 1};
      },
      [&](scene::Hazy) {
        return PhaseForm{Kind::hazy, 0, printed ? 1 : 0.5};
      },
      [&](scene::Murky) {
        return PhaseForm{Kind::murky, 0, printed ? 1 : 33.0 / 83};
      });
}

}  // namespace airlight::shadow_planes
