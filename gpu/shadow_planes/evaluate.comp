// An evaluator by itself: cases of airlight_integral (methods/shadow_planes/mapped_rule.h), one per invocation.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/angle.glsl"
#include "common/pi.glsl"
#include "shadow_planes/phase.glsl"
#include "shadow_planes/length.glsl"
#include "shadow_planes/evaluator.glsl"
#if POLYNOMIAL
#include "shadow_planes/polynomial.glsl"
#else
#include "shadow_planes/rule.glsl"
#endif

struct Case {
  float extinction, h;  // [1/m], [m]
  float d0, length_;    // [m] from the foot point on; 1e37: endless
};
layout(std430, binding = AT_CASES) readonly buffer Cases { Case cases[]; };
layout(std430, binding = AT_INTEGRALS) writeonly buffer Integrals { float integrals[]; };  // [1/m]
uniform int case_count;
uniform int phase_kind;
uniform float phase_g, phase_scale, phase_width;

float integral_of(Case of, float h) {
#if POLYNOMIAL
  float depth = of.extinction * h * (1 - q_at(of.d0, h));  // the way there, less that to the part's beginning
  return 4 * pi / of.extinction * polynomial_integral(of.extinction, h, of.d0, of.d0 + of.length_, depth);
#else
  Phase phase = Phase(phase_kind, phase_g, phase_scale, phase_width);
  Mapped map = map_part(phase.width, of.extinction, of.extinction, of.d0, of.length_, h);
  float sum = 0;
  for (int n = 0; n < rule_nodes; ++n) {
    Node node = node_of(map, n);
    sum += node.weight * exp(-of.extinction * h * node.further) * phase_of_halves(phase, node.v, node.w);
  }
  return sum;
#endif
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= case_count) return;
  float h = floor_of_h(cases[i].d0, cases[i].length_, cases[i].h);
  integrals[i] = h > 0 ? integral_of(cases[i], h) : 1e37;
}
