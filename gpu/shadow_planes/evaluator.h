// The evaluators of the airlight integral in single precision (rule.glsl, polynomial.glsl): their numbers, and each by
// itself.
#pragma once
#include <vector>

#include "gpu/buffer.h"
#include "methods/shadow_planes/phase_form.h"

namespace airlight::gpu::shadow_planes {

// 4 floats a node, as rule.glsl reads them. `root_ends` as MappedRule.
std::vector<float> rule_nodes(int nodes, int m, bool root_ends);

struct DeviceEvaluator {
  airlight::shadow_planes::PhaseForm phase;
  bool polynomial = false;  // the paper's, about theta = 0; else the mapped rule
  int nodes = 16;           // or the degree
  int stretch = 3;          // of the rule
};
struct EvaluatorCase {
  float extinction, h;  // [1/m], [m] > 0 unless the light lies outside the part
  float d0, length;     // [m] from the foot point on; far_away: endless
};
// Values of airlight_integral [1/m] for an isotropic light (methods/shadow_planes/mapped_rule.h). `seconds`: the
// device's time, transfers left out.
std::vector<float> integrals_on_device(Context&, const DeviceEvaluator&, const std::vector<EvaluatorCase>&,
                                       double* seconds = nullptr);

}  // namespace airlight::gpu::shadow_planes
