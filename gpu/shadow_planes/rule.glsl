// The mapped Gauss-Legendre rule in single precision: methods/shadow_planes/mapped_rule.h, for which a caller adds up its
// nodes. Needs POWER, m of the map.
#include "shadow_planes/length.glsl"

vec3 rule_node(int i) { return evaluator[i].xyz; }  // on [0, 1], 1 - node, weight
uniform int rule_nodes;

const float depth_cut = 20, endless = 1e30;

// A lit part as the rule maps it.
struct Mapped {
  float h;         // [m], not 0
  float q0, c;     // q - q0 = c ((1-s)^-m - 1)
  float s1, rest;  // s runs from 0 to s1 = 1 - rest
};

// Maps a lit part of `length_` [m] that begins at d0 [m] beyond the foot point; `width` is that of the phase function. The end of the
// part is cut off where e^(-slowest distance) is below e^-depth_cut.
Mapped map_part(float width, float extinction, float slowest, float d0, float length_, float h) {
  Mapped map;
  map.h = h;
  map.q0 = q_at(d0, h);
  float span = endless;  // q1 - q0 without the difference
  if (length_ < endless) {
    float d1 = d0 + length_, g = (d0 + d1) / (hypotenuse(d0, h) + hypotenuse(d1, h));
    span = g > 0 ? length_ * (1 + g) / h : map.q0 * q_at(d1, h) * length_ * (1 - g) / h;
  }
  float a = extinction * h;
  span = clamp(span, 1e-30, min(endless, depth_cut / max(slowest * h, 1e-30)));
  map.c = 1 / (0.1 * a + 1 / hypotenuse(width, map.q0));
  // With x = span / c: (1-s1)^m = 1/(1+x), and 1 - s1^... without cancellation, because 1 - t^m = x/(1+x).
  float x = span / map.c, sum = 1;
  map.rest = exp2(-log2(1 + x) / float(POWER));
  for (int k = 1; k < POWER; ++k) sum = sum * map.rest + 1;
  map.s1 = 1 / ((1 + 1 / x) * sum);
  return map;
}

struct Node {
  float q, v, w;   // v, w as phase.glsl
  float further;   // q - q0
  float weight;    // of (1/h) times the integral over q of 2/(1 + q^2) [1/m]
};
Node node_of(Mapped map, int i) {
  vec3 of_rule = rule_node(i);
  float s = map.s1 * of_rule.x, t = map.rest + map.s1 * of_rule.y;
  float power = 1, series = 0;  // t^m, 1 + t + ... + t^(m-1)
  for (int k = 0; k < POWER; ++k) {
    series += power;
    power *= t;
  }
  Node node;
  node.further = map.c * s * series / power;
  node.q = min(map.q0 + node.further, 1e18);
  node.v = 1 / (1 + node.q * node.q);
  node.w = node.q > 1 ? 1 / (1 + 1 / (node.q * node.q)) : node.q * node.q * node.v;
  node.weight = of_rule.z * 2 * node.v * map.c * float(POWER) / (power * t) * (map.s1 / map.h);
  return node;
}
