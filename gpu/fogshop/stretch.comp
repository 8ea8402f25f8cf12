// Variant S, first pass: the optical depth of every ray, the stretch of it that is sliced, and the nodes of the function whose equal
// steps are the slices' edges (methods/fogshop/ray_airlight.cpp, edges.cpp). One tile is one work group.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "common/opacity.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/near.glsl"
#include "fogshop/ray_values.glsl"
#include "fogshop/noise.glsl"
#include "fogshop/light.glsl"

uniform float clearest;  // least extinction_ratio above 0
uniform int even_steps, light_steps;

#if LIGHTS
// Writes the nodes in order: equal steps of the ray, and of the angle as seen from each light. Nodes of a light are found by rotating
// the vector (h, x) step by step, with the light's foot at x = 0.
void write_nodes(int ray, vec3 origin, vec3 direction, float lo, float hi) {
  vec2 turned[LIGHTS], turn[LIGHTS];
  float next[LIGHTS];
  int left[LIGHTS];
  LightFromRay seen[LIGHTS];
  for (int l = 0; l < LIGHTS; ++l) {
    seen[l] = light_from_ray(lights[l], origin, direction);
    float h = max(seen[l].h, least_h), xa = lo - seen[l].along, xb = hi - seen[l].along;
    float angle = angle_of(h * (hi - lo), h * h + xa * xb) / float(light_steps + 1), t = tangent(0.5 * angle);
    turn[l] = vec2((1 - t) * (1 + t), 2 * t) / (1 + t * t);
    turned[l] = vec2(h, xa);
    next[l] = lo;
    left[l] = light_steps + 1;  // the first is `lo` itself, and is left out
  }
  int even = 0;
  for (int k = -LIGHTS; k < node_count; ++k) {
    int from = -1;
    float t = even < even_steps ? lo + (hi - lo) * float(even) / float(even_steps) : hi;
    for (int l = 0; l < LIGHTS; ++l)
      if (left[l] > light_steps || (left[l] > 0 && next[l] < t)) t = next[l], from = l;
    if (k >= 0) ray_value[value_at(nodes + k, ray)] = t;
    if (from < 0) ++even;
    for (int l = 0; l < LIGHTS; ++l)
      if (l == from) {
        --left[l];
        turned[l] = vec2(turned[l].x * turn[l].x - turned[l].y * turn[l].y, turned[l].x * turn[l].y + turned[l].y * turn[l].x);
        float h = max(seen[l].h, least_h);
        next[l] = turned[l].x > 0 ? clamp(seen[l].along + h * (turned[l].y / turned[l].x), next[l], hi) : hi;
      }
  }
}
#endif

void main() {
  ivec2 pixel = pixel_of_strip();
  bool visible = is_computed(pixel);  // the others still help to load
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = visible ? ray_length(pixel) : 0;
  int count = near_count();
  if (count < 0) return;  // the whole tile

  // Reach of the Gaussians, the light that they take away, the depth of the whole ray.
  float reach_lo = far_away, reach_hi = -far_away, taken = 0, depth = 0;
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Crossing c = cross_geometry(near_block[i], origin, direction, end);
      if (!c.met) continue;
      add_view_depth(near_block[i], origin, direction, end, c);
      c.start = place_at(-c.a * c.middle);
      reach_lo = min(reach_lo, c.middle - c.chord);
      reach_hi = max(reach_hi, c.middle + c.chord);
      taken += opacity(2 * c.depth);
      depth += depth_at(c, end);
    }
  }
  if (constant > 0) depth += constant * end;
  if (visible) pixels[place_of(pixel)] = vec4(vec3(0), depth);
#if LIGHTS || SKY
  if (pixel.x >= grid_width) return;  // no place in the strip
  int ray = ray_of_strip();
  float lo = max(reach_lo, 0), hi = min(reach_hi, end);
  ray_value[value_at(reach_from, ray)] = lo;
  ray_value[value_at(reach_to, ray)] = visible ? hi : 0;
#if LIGHTS
  if (constant > 0) {
    float beyond = max(0, reach_hi), dark = 0;
    for (int l = 0; l < LIGHTS; ++l) {
      LightFromRay seen = light_from_ray(lights[l], origin, direction);
      beyond = max(beyond, abs(seen.along) + seen.h);
      float d_sv = length(vec2(seen.along, seen.h)), c = d_sv + 40 / (constant * clearest);
      dark = max(dark, 0.5 * (c - d_sv) * (c + d_sv) / (c - seen.along));
    }
    lo = 0;
    hi = min(min(end, beyond * (1 + float(slice_count) / 16)), dark);
  }
  bool sliced = visible && lo < hi;
  ray_value[value_at(slices_from, ray)] = sliced ? lo : 0;
  ray_value[value_at(slices_to, ray)] = sliced ? hi : 0;
  ray_value[value_at(opacity_sum, ray)] = taken;
  if (sliced) write_nodes(ray, origin, direction, lo, hi);
#endif
#endif
}
