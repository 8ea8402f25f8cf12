// One pixel per invocation: its ray's steps, and from each of them a shadow ray to every light. The scheme is that of
// reference/ray_marcher/scalar.h. A dispatch takes some tiles of the image.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
uniform int graded, skip_empty;
uniform int light_count, balls;  // the first `balls` of the lights are point and spot lights
#include "ray_marcher/layer.glsl"
#include "ray_marcher/light.glsl"
#include "ray_marcher/columns.glsl"
#include "ray_marcher/spacing.glsl"
#if OCCLUDERS
#include "ray_marcher/occluders.glsl"
#endif
#include "ray_marcher/pixel.glsl"
#include "ray_marcher/rounds.glsl"

layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
uniform int tile_columns;  // of the image
uniform int first_row;     // of the band
uniform int has_distances;
uniform float darkest;  // a ray ends at that optical depth

vec3 airlight = vec3(0);
uint step_count = 0, shadow_ray_count = 0, occlusion_ray_count = 0;
uint own_marches[BALL_WORDS];  // bit l: light l has a march of its own on this ray

// State of the current march: position, optical depth, and whether it ended because it became too dark.
int at_part, at_light;
float at_step;
float at_from, at_width;  // within the step: divided where it is deep
vec3 depth;
bool ended = false;

// A dispatch does one light at one step at least, however many iterations that takes.
bool moved = false;
bool out_of_budget() { return moved && work > uint(budget); }

#include "ray_marcher/step.glsl"

#if GRIDS
// From step i of a part on, how many steps lie in the free space of a grid; negative: how many may not. `start` and
// `delta`: local beginning of the part, and from one step to the next.
float free_run(int k, vec3 start, vec3 delta, float i) {
  vec3 p = start + (i + 0.5) * delta;
  float free = free_at(k, p);
  if (free >= 0) return 1 + floor(free / max(max(abs(delta.x), abs(delta.y)), abs(delta.z)));
  // To the nearest face of the brick that lies ahead; a step too many or too few changes no result.
  float run = 1e9;
  for (int a = 0; a < 3; ++a) {
    if (delta[a] == 0) continue;
    float face = float(((int(p[a]) >> 2) + (delta[a] > 0 ? 1 : 0)) << 2);
    run = min(run, (face - p[a]) / delta[a]);
  }
  return -1 - floor(max(run, 0));
}

// Free run over all grids of a part: > 0 steps that must be taken, < 0 steps that may be skipped.
float grids_run(Part part, vec3 start, vec3 delta, float i) {
  float taken = 0, free = 1e9;
  for (int k = 0; k < layer_count; ++k) {
    if ((part.in_varied >> k & 1u) == 0u) continue;
    float run = free_run(k, to_local(layers[k].field_frame, start), rotate_to_local(layers[k].field_frame, delta), i);
    if (run < 0)
      taken = max(taken, -run);
    else
      free = min(free, run);
  }
  return taken > 0 ? taken : -free;
}

bool grids_alone(Part part) {
  for (int k = 0; k < layer_count; ++k)
    if ((part.in_varied >> k & 1u) != 0u && layers[k].field != field_grid) return false;
  return part.in_constant == 0u;
}
#endif

// A march along the parts from where it is. False: no budget left.
bool march(vec3 origin, vec3 direction, int own, Approach seen) {
  float total = measure_of_all();
  ended = false;
  // Counters of the march advance at the ends of the loops, not in the head of a `for`: on an NVIDIA GPU (driver 580) rays that stopped
  // within one lost the rest of the step in hand. Whether this mends it was not measured there.
  while (at_part < part_count) {
    Part part = part_at(at_part);
    float share = measure(part);
    float n = step_length > 0 ? clamp(ceil(share / step_length), 1, 1048576)
                              : max(1, floor(float(steps) * (share / total) + 0.5));
    bool even = !part.zone && !part.grows;
    float h = (part.hi - part.lo) / n, until = n;
#if GRIDS
    bool skips = skip_empty != 0 && even && grids_alone(part) && !may_be_deep(part, h);
    if (skips) until = at_step;
#endif
    // Around the light from it, otherwise from the beginning of the part.
    float base = part.zone ? seen.t : part.lo, fall = exp_minus_one(-0.5 * growth * (part.hi - part.lo));
    while (at_step < n) {
      if (out_of_budget()) return false;
      ++work;
      float middle = (at_step + 0.5) * h, length_ = h;
#if GRIDS
      if (skips && at_step >= until) {
        float run = grids_run(part, origin + part.lo * direction, h * direction, at_step);
        until = at_step + max(run, 0);
        if (run < 0) {
          at_step += -run;
          continue;
        }
      }
#endif
      if (!even) {
        float end[2];
        for (int e = 0; e < 2; ++e) {
          float i = at_step + float(e), s = i / n;
          if (i == 0)
            end[e] = part.lo - base;
          else if (i == n)
            end[e] = part.hi - base;
          else if (part.zone)
            end[e] = seen.h * stretch(mix(part.u_lo, part.u_hi, s));
          else
            end[e] = -(2 / growth) * log_one_plus(s * fall);
        }
        middle = 0.5 * (end[0] + end[1]);
        length_ = end[1] - end[0];
        if (!(length_ > 0)) {
          ++at_step;
          continue;
        }
      }
      ended = all_above(depth, darkest);
      if (ended) return true;
      float x = part.zone ? middle : (base - seen.t) + middle;
      if (may_be_deep(part, length_)) {
        float half_length = 0.5 * length_;
        if (!march_deep_step(part, origin, direction, base + middle - half_length, x - half_length, length_, own))
          return false;
        if (ended) return true;
      } else if (!march_step(part, origin, direction, base + middle, x, length_, own)) {
        return false;
      }
      ++at_step;
    }
    at_step = 0;
    ++at_part;
  }
  return true;
}

void main() {
  int tile = tile_of_group();
  ivec2 at = ivec2(tile % tile_columns, tile / tile_columns) * ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y) +
             ivec2(gl_LocalInvocationID.xy);
  int place = at.y * width + at.x;
  at.y += first_row;
  if (at.x >= width || at.y >= height) return;
  Pixel pixel = Pixel(vec3(0), 0u, vec3(0), 0u, 0u, 0u, 0, 0, 0, 0, 0, 1);
  if (round_ > 0) pixel = pixels[place];
  int resumed = pixel.march;
  if (resumed > balls) return;
  vec3 origin, direction;
  camera_ray(vec2(at) + 0.5, origin, direction);
  float t_end = has_distances != 0 ? distances[at.y * width + at.x] : far_away;
  for (int i = 0; i < BALL_WORDS; ++i) own_marches[i] = 0u;
  at_part = pixel.part;
  at_step = pixel.step_;
  at_light = pixel.light;
  at_from = pixel.from;
  at_width = pixel.width_;
  depth = pixel.transmittance;

  // A light that grades the ray around itself has a march of its own. The common march, last, serves the transmittance and
  // every other light. One loop for both: compilers copy what is called into every place it is called from.
  int now = graded != 0 ? 0 : balls;
  bool done = true;
  for (; now <= balls; ++now) {
    bool own = now < balls;
    Approach seen = Approach(0, vec3(0), 0);
    if (own) seen = approach(lights[now], origin, direction);
    bool around = lay_parts(origin, direction, t_end, own, seen);
    if (own && !around) continue;
    if (own) own_marches[now >> 5] |= 1u << (now & 31);
    if (now < resumed) continue;
    done = march(origin, direction, own ? now : -1, seen);
    if (!done) break;
    if (!own) break;
    at_part = at_light = 0;
    at_step = at_from = 0;
    at_width = 1;
    depth = vec3(0);
  }
  vec3 result = depth;
  if (done) {
    result = exp(-depth);
    for (int c = 0; c < 3; ++c)
      if (ended || never_ends[c]) result[c] = 0;
  } else {
    leave_to_next_round(tile);
  }
  pixels[place] =
      Pixel(pixel.airlight + airlight, pixel.steps + step_count, result, pixel.shadow_rays + shadow_ray_count,
            pixel.shadow_steps + shadow_step_count, pixel.occlusion_rays + occlusion_ray_count, done ? balls + 1 : now,
            done ? 0 : at_part, at_step, done ? 0 : at_light, at_from, at_width);
}
