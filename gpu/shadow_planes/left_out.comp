// Shadow planes that cannot cut a medium's box: methods/shadow_planes/paper_stages.cpp (misses). One edge per invocation.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/edge.glsl"
#include "shadow_planes/light_state.glsl"

layout(std430, binding = AT_EDGES) buffer Edges { Edge edges[]; };
uniform dvec3 box_lo, box_hi;  // [m] from the light
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= edge_count) return;
  dvec3 a = dvec3(edges[i].a[0], edges[i].a[1], edges[i].a[2]), b = dvec3(edges[i].b[0], edges[i].b[1], edges[i].b[2]);
  dvec3 normal = cross(a, b), by_a = cross(normal, a), by_b = cross(b, normal);
  dvec3 across = cross(normal, b - a);  // away from the edge, towards the light
  int above = 0, below = 0, outside_a = 0, outside_b = 0, before = 0;
  for (int k = 0; k < 8; ++k) {
    dvec3 c = mix(box_lo, box_hi, notEqual(ivec3(k & 1, k & 2, k & 4), ivec3(0)));
    above += int(dot(normal, c) > 0);
    below += int(dot(normal, c) < 0);
    outside_a += int(dot(by_a, c) < 0);
    outside_b += int(dot(by_b, c) < 0);
    before += int(dot(across, c - a) > 0);
  }
  edges[i].left_out = int(above == 8 || below == 8 || outside_a == 8 || outside_b == 8 || before == 8);
}
