// Optical depths of steps along the rays of texels: LightMap::march of reference/light_map. An invocation does some steps of one
// texel. Texels of the border are those that they repeat.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "ray_marcher/layer.glsl"
#include "light_map/texel.glsl"

// Each layer that varies: its place relative to the scene's middle, and the extinction of the map's planes at density 1 [1/m].
struct Part {
  vec4 lo, hi;  // lo.w: 0, nothing of the layer varies
  vec4 extinction;
};
layout(std140, binding = AT_PARTS) uniform Parts { Part parts[LAYERS]; };
layout(std430, binding = AT_STEPS) buffer Steps { float step_depth[]; };  // texel fastest, then step, then plane
uniform int steps_at_once;
uniform int octahedral;
uniform double reach;                      // octahedral: half the side of the map's square
uniform dvec3 map_x, map_y, map_axis;      // axes of the map
uniform dvec3 corner;                      // orthographic: of texel (0, 0), at the beginning of the depths; else the light
uniform double texel_width, texel_height;  // orthographic [m]
uniform double near;                       // octahedral: depth where steps begin [m]
uniform float step_length;                 // [m]

void texel_ray(ivec2 texel, out vec3 origin, out vec3 direction) {
  dvec2 at = dvec2(texel) + 0.5LF;
  if (octahedral == 0) {
    origin = vec3(corner + at.x * texel_width * map_x + at.y * texel_height * map_y);
    direction = vec3(map_axis);
    return;
  }
  dvec2 uv = reach * (2 * at / double(map_size) - 1);
  double w = 1 - abs(uv.x) - abs(uv.y);
  if (w < 0) uv = (1 - abs(uv.yx)) * dvec2(uv.x < 0 ? -1 : 1, uv.y < 0 ? -1 : 1);
  dvec3 towards = normalize(uv.x * map_x + uv.y * map_y + w * map_axis);
  origin = vec3(corner + near * towards);
  direction = vec3(towards);
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= texel_count) return;
  vec3 origin, direction;
  texel_ray(texel_at(first_texel + i), origin, direction);
  int first = int(gl_GlobalInvocationID.y) * steps_at_once;
  float range = step_length * float(steps);
  for (int s = first; s < min(first + steps_at_once, steps); ++s)
    for (int c = 0; c < MAP_PLANES; ++c) step_depth[(c * steps + s) * texel_count + i] = 0;
  for (int k = 0; k < layer_count; ++k) {
    if (parts[k].lo.w == 0) continue;
    vec2 inside = clip_region(k, origin, direction, vec2(0, range));
    if (inside.x < inside.y)
      inside = layers[k].field == field_grid ? clip_field(k, origin, direction, inside)
                                             : clip_box(parts[k].lo.xyz, parts[k].hi.xyz, origin, direction, inside);
    if (!(inside.x < inside.y)) continue;
    for (int s = first; s < min(first + steps_at_once, steps); ++s) {
      vec2 part = vec2(max(float(s) * step_length, inside.x), min(float(s + 1) * step_length, inside.y));
      if (!(part.x < part.y)) continue;
      float column = varied_density(k, origin + 0.5 * (part.x + part.y) * direction) * (part.y - part.x);
      for (int c = 0; c < MAP_PLANES; ++c)
        step_depth[(c * steps + s) * texel_count + i] += parts[k].extinction[c] * column;
    }
  }
}
