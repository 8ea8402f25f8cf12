// Media and light of a batch of frames in every froxel, blended into what the volume holds: reference/froxel_fog/frames.cpp. An
// invocation does all frames of its froxel, as many lights as a round allows (ray_marcher/rounds.glsl).
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "lit_media/lit_media.glsl"
#include "ray_marcher/rounds.glsl"
#include "froxel_fog/grid.glsl"
#include "froxel_fog/slices.glsl"
#if HISTORY
#include "froxel_fog/history.glsl"
#endif

// Source [W/m^3/sr] and extinction [1/m]; w: the frame and the step of it where a round ended, 0 the blend, l + 1 light l.
layout(std430, binding = AT_LIGHT) buffer FroxelLight { vec4 froxel_light[]; };
layout(std430, binding = AT_MEDIA) buffer FroxelMedia { vec4 froxel_media[]; };
layout(std430, binding = AT_ENDS) readonly buffer Ends { float ends[]; };  // of the rays of each frame [m]
layout(std430, binding = AT_FRAMES) readonly buffer Frames { vec4 frames[]; };  // jitter, weight of the history
// Low and high words: points, look-ups, occlusion rays, reprojected froxels.
layout(std430, binding = AT_FROXEL_TOTALS) buffer Totals { uint totals[8]; };
uniform int first_frame, frame_count;  // of the batch
uniform int tile_columns, tile_rows;   // of the grid
uniform int first_slice;               // of this dispatch
uniform int has_ends, counts;
uniform float history_weight;  // of a froxel that the last picture knows

uint reprojected = 0;

// The frames of one froxel from where it is. False: no budget left.
bool fill(ivec3 at, inout vec3 light, inout vec3 media, inout int frame, inout int step_) {
  bool moved = false;
  // Counters advance at the ends of the loops: ray_marcher/march.comp.
  while (frame < frame_count) {
    if (moved && work > uint(budget)) return false;
    vec4 look = frames[first_frame + frame];
    vec3 origin, direction;
    camera_ray(cell_size() * (vec2(at.xy) + look.xy), origin, direction);
    float t = slice_values[sample_at(frame, at.z)] / depth_per_metre(direction);
    bool seen = has_ends == 0 || t < ends[(frame * rows + at.y) * columns + at.x];
    vec3 x = origin + t * direction, extinction = vec3(0);
    uint points = lit_points;
    if (seen) extinction = lit_extinction(x);
    float weight = look.w;
#if HISTORY
    vec3 middle_origin, middle_direction, old_light, old_media;
    camera_ray(cell_size() * (vec2(at.xy) + 0.5), middle_origin, middle_direction);
    float to_middle = slice_values[middle_at(at.z)] / depth_per_metre(middle_direction);
    bool known = history_at(middle_origin + to_middle * middle_direction, old_light, old_media);
    weight = known ? history_weight : 0;
    if (step_ == 0) light = old_light, media = old_media, reprojected += uint(known);
#endif
    if (step_ == 0) {
      light *= weight;
      media = extinction + weight * (media - extinction);
      step_ = 1;
    } else {
      lit_points = points;  // counted when the frame began
    }
    int end = extinction != vec3(0) ? lit_lights : 0;
    while (step_ <= end) {
      if (moved && work > uint(budget)) return false;
      light += (1 - weight) * lit_source(step_ - 1, x, direction);
      moved = true;
      ++step_;
    }
    step_ = 0;
    moved = true;
    ++frame;
  }
  return true;
}

void fill_froxel() {
  int tile = tile_of_group(), of_slice = tile % (tile_columns * tile_rows);
  ivec3 at = ivec3(ivec2(of_slice % tile_columns, of_slice / tile_columns) * ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y) +
                       ivec2(gl_LocalInvocationID.xy),
                   first_slice + tile / (tile_columns * tile_rows));
  if (at.x >= columns || at.y >= rows || slice_values[2] == 0) return;
  int place = froxel_at(at.x, at.y, at.z), frame = 0, step_ = 0;
  vec3 light = vec3(0), media = vec3(0);
  if (round_ > 0 || first_frame > 0) {
    light = froxel_light[place].rgb, media = froxel_media[place].rgb;
    if (round_ > 0) frame = int(froxel_media[place].w), step_ = int(froxel_light[place].w);
  }
  if (frame >= frame_count) return;
  if (!fill(at, light, media, frame, step_)) leave_to_next_round(tile);
  froxel_light[place] = vec4(light, float(step_));
  froxel_media[place] = vec4(media, float(frame));
}

shared uint of_group[4];

void main() {
  if (gl_LocalInvocationIndex < 4u) of_group[gl_LocalInvocationIndex] = 0u;
  barrier();
  fill_froxel();
  if (counts == 0) return;
  atomicAdd(of_group[0], lit_points);
  atomicAdd(of_group[1], lit_look_ups);
  atomicAdd(of_group[2], lit_occlusion_rays);
  atomicAdd(of_group[3], reprojected);
  barrier();
  if (gl_LocalInvocationIndex >= 4u) return;
  int me = int(gl_LocalInvocationIndex);
  uint low = of_group[me];
  if (atomicAdd(totals[2 * me], low) > 0xffffffffu - low) atomicAdd(totals[2 * me + 1], 1u);
}
