// The marched film of this picture: the mean of frames; with HISTORY, the last picture's film is blended in where its rays were in that
// (reference/half_resolution_march/history.h).
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/far_away.glsl"
#include "half_resolution_march/blocks.glsl"

layout(std430, binding = AT_LOW) writeonly buffer Low { LowPixel low[]; };
uniform int frames;

vec3 mean_airlight(int place) { return blocks[place].airlight / float(frames); }
vec3 mean_transmittance(int place) { return blocks[place].transmittance / float(frames); }

#if HISTORY
layout(std430, binding = AT_LAST) readonly buffer Last { LowPixel last[]; };
uniform float history_weight;
uniform int clamps;
// This view and the last one: right and up over half the film's size.
uniform vec3 view_position[2], view_forward[2], view_right[2], view_up[2];
uniform int parallel[2];

// Film position [pixels] and depth along the axis [m]: film_position of scene/camera_rays.h.
vec3 film_position(int view, vec3 x) {
  vec3 from = x - view_position[view];
  float depth = dot(from, view_forward[view]), size = parallel[view] != 0 ? 1 : depth;
  vec2 at = vec2(dot(from, view_right[view]), -dot(from, view_up[view])) / size;
  return vec3(0.5 * (1 + at) * vec2(width, height), depth);
}

// False: the block was not in the last picture.
bool look_up(ivec2 at, Block block, out vec3 airlight, out vec3 transmittance) {
  airlight = transmittance = vec3(0);
  vec3 origin, direction;
  camera_ray(block.film, origin, direction);
  vec3 point = origin + block.distance_ * direction, now = film_position(0, point), before = film_position(1, point);
  if (!(before.z > 0 && all(greaterThanEqual(before.xy, vec2(0))) && all(lessThanEqual(before.xy, vec2(width, height)))))
    return false;
  float depth = block.t_end >= far_away ? far_away : film_position(1, origin + block.t_end * direction).z;
  vec2 film = vec2(block_center(at.x, width), block_center(at.y, height)) + (before.xy - now.xy);
  Neighbours across = neighbours_at(film.x, width, block_columns), down = neighbours_at(film.y, height, block_rows);
  float total = 0;
  for (int k = 0; k < 4; ++k) {
    bool right = (k & 1) != 0, below = k > 1;
    int place = (below ? down.second : down.first) * block_columns + (right ? across.second : across.first);
    float weight = (right ? across.share : 1 - across.share) * (below ? down.share : 1 - down.share);
    if (depth_difference(last[place].depth, depth) > edge_length()) continue;
    airlight += weight * last[place].airlight;
    transmittance += weight * last[place].transmittance;
    total += weight;
  }
  airlight /= max(total, 1e-30);
  transmittance /= max(total, 1e-30);
  return total >= 0.01;
}

// Limits what the last picture has to the range of the blocks around. True: that changed it, and not all of them are clear
// to 1e-6. Light of clear blocks comes from places at the edge of smoke, and rounding decides on which side they are.
bool limit(ivec2 at, inout vec3 airlight, inout vec3 transmittance) {
  int own = at.y * block_columns + at.x;
  vec3 least = mean_airlight(own), most = least, thick = mean_transmittance(own), clear = thick;
  for (int j = max(0, at.y - 1); j <= min(block_rows - 1, at.y + 1); ++j)
    for (int i = max(0, at.x - 1); i <= min(block_columns - 1, at.x + 1); ++i) {
      int place = j * block_columns + i;
      vec3 a = mean_airlight(place), t = mean_transmittance(place);
      least = min(least, a), most = max(most, a), thick = min(thick, t), clear = max(clear, t);
    }
  vec3 limited = clamp(airlight, least, most), through = clamp(transmittance, thick, clear);
  bool all_clear = all(greaterThan(min(thick, transmittance), vec3(1 - 1e-6))), changed = limited != airlight || through != transmittance;
  airlight = limited;
  transmittance = through;
  return changed && !all_clear;
}
#endif

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= block_columns || at.y >= block_rows) return;
  int place = at.y * block_columns + at.x;
  vec3 airlight = mean_airlight(place), transmittance = mean_transmittance(place);
#if HISTORY
  if (blocks[place].distance_ >= 0) {
    vec3 old_airlight, old_transmittance;
    if (look_up(at, blocks[place], old_airlight, old_transmittance)) {
      atomicAdd(history_used, 1u);
      if (clamps != 0 && limit(at, old_airlight, old_transmittance)) atomicAdd(history_clamped, 1u);
      airlight += history_weight * (old_airlight - airlight);
      transmittance += history_weight * (old_transmittance - transmittance);
    } else {
      atomicAdd(history_rejected, 1u);
    }
  }
#endif
  low[place] = LowPixel(airlight, blocks[place].depth, transmittance, 0);
}
