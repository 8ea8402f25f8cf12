// Where each camera ray is in the smoke, and in how many slices.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "compensated_ray_marching/smoke_density.glsl"
layout(std430, binding = AT_RANGES) writeonly buffer Ranges { vec4 ranges[]; };  // start, length of a slice [m], slices, slope
layout(std430, binding = AT_AIRLIGHT_LAYER) writeonly buffer Airlight { float airlight[]; };
layout(std430, binding = AT_COLUMN) writeonly buffer Column { float column[]; };  // [m]
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // where something ends the ray [m]
uniform int has_ends;
uniform float slice;           // across [m]
#if GAUSSIANS
#include "compensated_ray_marching/tile_gaussians.glsl"
#endif

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  bool within_film = at.x < width && at.y < height;
  vec3 origin, direction;
  camera_ray(vec2(at) + 0.5, origin, direction);
  vec2 t = vec2(1e37, -1e37);
#if GAUSSIANS
  if (!begin_tile(within_film, origin, direction, vec2(0, 1e37))) return;
  for (int turn = 0; turn * tile_lanes < gaussian_count; ++turn) {
    look_at(turn);
    for (int w = 0; w < tile_words; ++w)
      for (uint left = tile_word(turn, w); left != 0u; left &= left - 1u) {
        float nearest, aside;
        vec2 part = within(gaussians[turn * tile_lanes + 32 * w + findLSB(left)], farthest, origin, direction, nearest, aside);
        part.x = max(part.x, 0.0);
        if (part.x < part.y) t = vec2(min(t.x, part.x), max(t.y, part.y));
      }
  }
#else
  vec3 o = sample_at(origin), d = to_samples * direction;
  t = vec2(0, 1e37);
  for (int a = 0; a < 3; ++a) {
    float lo = -border, hi = samples_along[a] - 1 + border;
    if (abs(d[a]) < 1e-20) {
      if (o[a] < lo || o[a] > hi) t = vec2(1, -1);
    } else {
      float p = (lo - o[a]) / d[a], q = (hi - o[a]) / d[a];
      t = vec2(max(t.x, min(p, q)), min(t.y, max(p, q)));
    }
  }
#endif
  if (!within_film) return;
  int place = at.y * width + at.x;
  vec2 region = region_part(origin, direction);
  t = vec2(max(t.x, region.x), min(t.y, region.y));
  if (has_ends != 0) t.y = min(t.y, distances[place]);
  ranges[place] = vec4(0);
  if (t.x < t.y) {
    float slope = max(dot(direction, camera_forward), 1e-3), count = max(1.0, ceil((t.y - t.x) * slope / slice));
    ranges[place] = vec4(t.x, (t.y - t.x) / count, count, slope);
  }
  column[place] = 0;
  for (int c = 0; c < 3; ++c) airlight[3 * place + c] = 0;
}
