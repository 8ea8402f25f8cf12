// The steps of each block's ray, one ray per invocation: march and marched_stretch of reference/half_resolution_march/march.cpp. A dispatch
// does as many as a round allows (gpu/ray_marcher/rounds.h).
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "common/opacity.glsl"
#include "lit_media/lit_media.glsl"
#include "half_resolution_march/blocks.glsl"
#include "half_resolution_march/jitter.glsl"
#include "ray_marcher/rounds.glsl"

uniform int tile_columns;
uniform int steps, frames, first_frame;
uniform int from_camera, analytic;
uniform int airlight_depth;  // distance_: of the airlight; else of the ray's end
uniform float horizon;       // optical depth at which endless media are cut

struct Stretch {
  vec2 t;  // [m]; empty unless x < y
  float in_media;
  vec3 beyond;
};

Stretch marched_stretch(vec3 origin, vec3 direction, float t_end) {
  vec2 t = lit_extent(origin, direction, vec2(0, t_end));
  vec3 endless_extinction = vec3(0), beyond = vec3(1);
  float begin = 0, finite = 0, thinnest = far_away;
  for (int k = 0; k < layer_count; ++k) {
    vec2 region = clip_region(k, origin, direction, vec2(0, far_away)), varied = nothing;
    if (!(region.x < region.y)) continue;
    if (layers[k].field != field_none) varied = clip_field(k, origin, direction, region);
    if (varied.x < varied.y) finite = max(finite, varied.y);
    if (layers[k].constant > 0 && region.y < far_away) finite = max(finite, region.y);
    if (layers[k].constant > 0 && region.y >= far_away) {
      endless_extinction += layers[k].constant * layers[k].sigma_t;
      begin = max(begin, region.x);
    }
  }
  bool all_channels = true;
  for (int c = 0; c < 3; ++c)
    if (endless_extinction[c] > 0)
      thinnest = min(thinnest, endless_extinction[c]);
    else
      all_channels = false;
  if (thinnest < far_away) {
    float end = begin + horizon / thinnest;
    // A channel that sees through endless fog sees everything else.
    if (!all_channels) end = max(end, finite);
    if (end < t.y) {
      t.y = end;
      for (int c = 0; c < 3; ++c)
        if (endless_extinction[c] > 0) beyond[c] = 0;
    }
  }
  float length_ = t.y - t.x;
  if (from_camera != 0 && t.x < t.y) t.x = 0;
  return Stretch(t, length_, beyond);
}

// The rest of a frame's steps. False: no budget left.
bool march(inout Block block, vec3 origin, vec3 direction, vec2 range, float offset, inout bool moved) {
  float h = (range.y - range.x) / float(steps);
  while (block.step_ < steps) {
    if (moved && work > uint(budget)) return false;
    ++work;
    float t = range.x + (float(block.step_) + offset) * h;
    vec3 point = origin + t * direction;
    uint points = lit_points;
    vec3 extinction = lit_extinction(point);
    if (block.light > 0) lit_points = points;  // counted in the round before
    vec3 through, length_;
    for (int c = 0; c < 3; ++c) {
      float depth = extinction[c] * h, taken = opacity(depth);
      through[c] = depth > 0.6 ? exp(-depth) : 1 - taken;
      length_[c] = analytic == 0 ? h * through[c] : extinction[c] > 0 ? taken / extinction[c] : h;
    }
    length_ *= block.frame_transmittance;
    int light = block.light, end = extinction == vec3(0) ? 0 : lit_lights;
    while (light < end && !(moved && work > uint(budget))) {
      vec3 scattered = length_ * lit_source(light, point, direction);
      block.frame_airlight += scattered;
      block.weighted += t * (scattered.x + scattered.y + scattered.z);
      moved = true;
      ++light;
    }
    if (light < end) {
      block.light = light;
      return false;
    }
    block.frame_transmittance *= through;
    block.light = 0;
    moved = true;
    ++block.step_;
  }
  return true;
}

void main() {
  int tile = tile_of_group();
  ivec2 at = ivec2(tile % tile_columns, tile / tile_columns) * ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y) +
             ivec2(gl_LocalInvocationID.xy);
  if (at.x >= block_columns || at.y >= block_rows) return;
  int place = at.y * block_columns + at.x;
  Block block = blocks[place];
  if (round_ == 0) {
    block.airlight = block.transmittance = block.frame_airlight = vec3(0);
    block.frame_transmittance = vec3(1);
    block.frame = block.step_ = block.light = 0;
    block.weighted = 0;
    block.distance_ = -1;
    block.points = block.look_ups = block.occlusion_rays = 0u;
  }
  if (block.frame >= frames) return;
  vec3 origin, direction;
  camera_ray(block.film, origin, direction);
  Stretch stretch = marched_stretch(origin, direction, block.t_end);
  bool moved = false, done = true;
  if (!(stretch.t.x < stretch.t.y)) {
    block.transmittance = vec3(frames);
    block.frame = frames;
  } else if (round_ == 0) {
    atomicMax(longest_bits, floatBitsToUint(stretch.in_media));
  }
  while (block.frame < frames && done) {
    done = march(block, origin, direction, stretch.t, step_offset(at, first_frame + block.frame), moved);
    if (!done) continue;
    block.airlight += block.frame_airlight;
    block.transmittance += stretch.beyond * block.frame_transmittance;
    float airlight = block.frame_airlight.x + block.frame_airlight.y + block.frame_airlight.z;
    block.distance_ = airlight_depth == 0 ? stretch.t.y
                      : airlight > 0      ? block.weighted / airlight
                                          : 0.5 * (stretch.t.x + stretch.t.y);
    block.frame_airlight = vec3(0);
    block.frame_transmittance = vec3(1);
    block.weighted = 0;
    block.step_ = 0;
    ++block.frame;
  }
  block.points += lit_points;
  block.look_ups += lit_look_ups;
  block.occlusion_rays += lit_occlusion_rays;
  blocks[place] = block;
  if (!done) leave_to_next_round(tile);
}
