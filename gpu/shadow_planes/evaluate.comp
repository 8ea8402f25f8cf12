// The rule by itself: cases of (methods/shadow_planes/mapped_rule.h) airlight_integral, one per invocation.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/phase.glsl"
#include "shadow_planes/rule.glsl"

struct Case {
  float extinction, h;    // [1/m], [m]
  float d0, length_;      // [m] from the foot point on; 1e37: endless
};
layout(std430, binding = 0) readonly buffer Cases { Case cases[]; };
layout(std430, binding = 1) writeonly buffer Integrals { float integrals[]; };  // [1/m]
uniform int case_count;
uniform int phase_kind;
uniform float phase_g, phase_scale, phase_width;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= case_count) return;
  Case of = cases[i];
  Phase phase = Phase(phase_kind, phase_g, phase_scale, phase_width);
  float h = floor_of_h(of.d0, of.length_, of.h);
  if (!(h > 0)) {
    integrals[i] = 1e37;
    return;
  }
  Mapped map = map_part(phase.width, of.extinction, of.d0, of.length_, h);
  float sum = 0;
  for (int n = 0; n < rule_nodes; ++n) {
    Node node = node_of(map, n);
    sum += node.weight * exp(-of.extinction * h * node.further) * phase_of_halves(phase, node.v, node.w);
  }
  integrals[i] = sum;
}
