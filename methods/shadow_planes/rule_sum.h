// The rule's sum over its nodes for a light that is the same in all directions, on vectors.
#pragma once
#include "methods/shadow_planes/mapped_rule.h"

namespace airlight::shadow_planes {

// airlight_integral [1/m] of mapped_rule.h with intensity 1, to rounding.
double isotropic_integral(const MappedRule<double>&, const PhaseForm&, double extinction, double T, double h,
                          const LitPart<double>&);

}  // namespace airlight::shadow_planes
