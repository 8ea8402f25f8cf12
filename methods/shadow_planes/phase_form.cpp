#include "methods/shadow_planes/phase_form.h"

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
  if (std::holds_alternative<scene::Rayleigh>(phase)) return {Kind::rayleigh, 0, 1};
  if (std::holds_alternative<scene::Hazy>(phase)) return {Kind::hazy, 0, printed ? 1 : 0.5};
  if (std::holds_alternative<scene::Murky>(phase)) return {Kind::murky, 0, printed ? 1 : 33.0 / 83};
  if (const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase)) return {Kind::henyey_greenstein, hg->g, 1};
  return {};
}

}  // namespace airlight::shadow_planes
