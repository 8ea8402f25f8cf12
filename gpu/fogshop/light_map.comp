// Depths of the Gaussians around one light: a texel per invocation, exact at its centre (methods/fogshop/light_map.cpp).
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "fogshop/fog.glsl"
#include "fogshop/light.glsl"

layout(std430, binding = AT_LIGHT_MAPS) buffer Maps { float map_depth[]; };
uniform int light_index;

vec2 fold(vec2 p) { return (1 - abs(p.yx)) * vec2(p.x >= 0 ? 1 : -1, p.y >= 0 ? 1 : -1); }

vec3 texel_direction(Light light, int i, int j) {
  int n = map_directions;
  if (light.map_tangent > 0) {
    vec2 p = light.map_tangent * (2 * (vec2(i, j) + 0.5) / float(n) - 1);
    return normalize(p.x * light.axis_x + p.y * light.axis_y + light.axis_z);
  }
  // Beyond an edge of the square lies the same edge, reversed.
  if (i < 0 || i >= n) {
    i = clamp(i, 0, n - 1);
    j = n - 1 - j;
  }
  if (j < 0 || j >= n) {
    j = clamp(j, 0, n - 1);
    i = n - 1 - i;
  }
  vec2 p = 2 * (vec2(i, j) + 0.5) / float(n) - 1;
  float z = 1 - abs(p.x) - abs(p.y);
  return normalize(vec3(z >= 0 ? p : fold(p), z));
}

void main() {
  int side = map_directions + 2;
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= side || texel.y >= side) return;
  Light light = lights[light_index];
  vec3 direction = texel_direction(light, texel.x - 1, texel.y - 1);
  int base = light.map_offset + (texel.y * side + texel.x) * (map_edges + 1);
  // Eight edges at a time, in registers.
  for (int first = 0; first <= map_edges; first += 8) {
    float at[8], sum[8];
    for (int k = 0; k < 8; ++k) at[k] = map_distance(light, min(first + k, map_edges)), sum[k] = 0;
    for (int i = 0; i < gaussian_count; ++i) {
      Crossing c = cross_line(gaussians[i], light.position, direction, light.map_far);
      if (!c.met) continue;
#define ADD(k) sum[k] += depth_at(c, at[k]);
      ADD(0) ADD(1) ADD(2) ADD(3) ADD(4) ADD(5) ADD(6) ADD(7)
    }
    for (int k = 0; k < 8 && first + k <= map_edges; ++k) map_depth[base + first + k] = sum[k];
  }
}
