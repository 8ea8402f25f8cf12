// The mapped rule in single precision (rule.glsl): its nodes, and the rule by itself.
#pragma once
#include <vector>

#include "gpu/buffer.h"
#include "methods/shadow_planes/phase_form.h"

namespace airlight::gpu {

// 4 floats a node, as rule.glsl reads them. `root_ends` as MappedRule.
std::vector<float> rule_nodes(int nodes, int m, bool root_ends);

// Values of airlight_integral [1/m] for an isotropic light (methods/shadow_planes/mapped_rule.h).
struct RuleCase {
  float extinction, h;  // [1/m], [m]
  float d0, length;     // [m] from the foot point on; far_away: endless
};
std::vector<float> rule_integrals(Context&, const shadow_planes::PhaseForm&, int nodes, int m,
                                  const std::vector<RuleCase>&);

}  // namespace airlight::gpu
