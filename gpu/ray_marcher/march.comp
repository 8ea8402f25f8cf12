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

layout(std430, binding = 5) readonly buffer Distances { float distances[]; };
uniform int tile_columns;  // of the image
uniform int first_row;     // of the band
uniform int has_distances;
uniform float darkest;  // a ray ends at that optical depth

vec3 airlight = vec3(0);
uint step_count = 0, shadow_ray_count = 0, occlusion_ray_count = 0;
uint own_marches[BALL_WORDS];  // bit l: light l has a march of its own on this ray

// Of the march under way: where it is, its optical depth, whether it was too dark to go on.
int at_part, at_light;
float at_step;
float at_from, at_width;  // within the step: divided where it is deep
vec3 depth;
bool ended = false;

// A dispatch does one light at one step at least, however many iterations that takes.
bool moved = false;
bool out_of_budget() { return moved && work > uint(budget); }

// (1 - exp(-x)) / x, 1 at x = 0.
float mean_over_step(float x) { return x > 0 ? -exp_minus_one(-x) / x : 1; }
bool all_above(vec3 x, float limit) { return all(greaterThan(x, vec3(limit))); }

LIST(float, density_here, LAYERS);  // of each layer at a step

// What a step sends to the camera of one light's radiance; x as for incidence().
void scatter(int l, Approach a, float x, vec3 point, vec3 direction, float length_, vec3 weight) {
  Light light = lights[l];
  Incidence from = incidence(light, a, x, direction, length_);
  if (from.strength == 0) return;
  work += uint(4 * LAYERS);
#if OCCLUDERS
  ++occlusion_ray_count;
  if (occluded(point, from.to_light, from.distance)) return;
#endif
  ++shadow_ray_count;
  vec3 to_light = vec3(0);
  for (int k = 0; k < layer_count; ++k)
    to_light += layers[k].sigma_t * column_of(k, point, from.to_light, from.distance);
  vec3 arrives = from.strength * exp(-to_light);
  vec3 less = from.to_light - direction, more = from.to_light + direction;
  float minus = 0.5 * dot(less, less), plus = 0.5 * dot(more, more);
  for (int k = 0; k < layer_count; ++k)
    airlight += light.colour * layers[k].albedo * layers[k].sigma_t * density_here[MINE(k)] *
                (weight * arrives * phase_value(layers[k].phase, layers[k].g, minus, plus));
}

// One step of a part, at t, and at x behind the light of an own march. Adds to the optical depth. False: no budget left,
// lights from at_light on have still to be done.
bool march_step(Part part, vec3 origin, vec3 direction, float t, float x, float length_, int own) {
  vec3 point = origin + t * direction;
  vec3 extinction = vec3(0);
  work += uint(4 * LAYERS);
  for (int k = 0; k < layer_count; ++k) {
    float density = (part.in_constant >> k & 1u) != 0u ? layers[k].constant : 0;
    if ((part.in_varied >> k & 1u) != 0u) density += varied_density(k, point);
    density_here[MINE(k)] = density;
    extinction += layers[k].sigma_t * density;
  }
  vec3 of_step = extinction * length_;
  vec3 weight = exp(-depth) * vec3(mean_over_step(of_step.x), mean_over_step(of_step.y), mean_over_step(of_step.z)) * length_;
  bool any_scatters = extinction * weight != vec3(0);
  int begin = own < 0 ? 0 : own, end = any_scatters ? (own < 0 ? light_count : own + 1) : begin;
  for (int l = max(begin, at_light); l < end; ++l) {
    if (own < 0 && l < balls && (own_marches[l >> 5] >> (l & 31) & 1u) != 0u) continue;
    if (out_of_budget()) {
      at_light = l;
      return false;
    }
    Approach a = approach(lights[l], origin, direction);
    scatter(l, a, own < 0 ? t - a.t : x, point, direction, length_, weight);
    moved = true;
  }
  at_light = 0;
  moved = true;
  step_count += uint(bitCount(part.in_varied));
  depth += of_step;
  return true;
}

// Steps that follow the optical depth: reference/ray_marcher/depth.h.
uniform float deepest_step;
const float least_width = 1.0 / 16777216;

vec3 extinction_at(Part part, vec3 point) {
  vec3 sum = vec3(0);
  for (int k = 0; k < layer_count; ++k) {
    float density = (part.in_constant >> k & 1u) != 0u ? layers[k].constant : 0;
    if ((part.in_varied >> k & 1u) != 0u) density += varied_density(k, point);
    sum += density * layers[k].sigma_t;
  }
  return sum;
}
bool is_deep(vec3 before, vec3 greatest, float length_, bool whole) {
  for (int c = 0; c < 3; ++c) {
    float own = greatest[c] * length_, most = whole ? 2 : 1;
    if (before[c] < deepest && own > most * deepest_step) return true;
  }
  return false;
}
bool may_be_deep(Part part, float length_) {
  vec3 most = vec3(0);
  for (int k = 0; k < layer_count; ++k) {
    if ((part.in_constant >> k & 1u) != 0u) most += layers[k].constant * layers[k].sigma_t;
    if ((part.in_varied >> k & 1u) != 0u) most += layers[k].most_varied * layers[k].sigma_t;
  }
  return is_deep(vec3(0), most, length_, true);
}

// A step that may be deep, [t, t + length] behind the light by x, from where it is. False: no budget left.
bool march_deep_step(Part part, vec3 origin, vec3 direction, float t, float x, float length_, int own) {
  while (at_from < 1) {
    if (out_of_budget()) return false;
    ++work;
    float lo = at_from * length_, h = at_width * length_, middle = lo + 0.5 * h;
    vec3 greatest = vec3(0);
    for (int i = 0; i < 3; ++i)
      greatest = max(greatest, extinction_at(part, origin + (t + lo + 0.5 * float(i) * h) * direction));
    if (at_width > least_width && is_deep(depth, greatest, h, at_width == 1)) {
      at_width *= 0.5;
      moved = true;
      continue;
    }
    ended = all_above(depth, darkest);
    if (ended) return true;
    if (!march_step(part, origin, direction, t + middle, x + middle, h, own)) return false;
    at_from += at_width;
    while (at_from < 1 && fract(at_from / (2 * at_width)) == 0) at_width *= 2;
  }
  at_from = 0;
  at_width = 1;
  return true;
}

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

// The same for all grids of a part: > 0 steps that must be taken, < 0 steps that may be left out.
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
  for (; at_part < part_count; ++at_part) {
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
    for (; at_step < n; ++at_step) {
      if (out_of_budget()) return false;
      ++work;
      float middle = (at_step + 0.5) * h, length_ = h;
#if GRIDS
      if (skips && at_step >= until) {
        float run = grids_run(part, origin + part.lo * direction, h * direction, at_step);
        until = at_step + max(run, 0);
        if (run < 0) {
          at_step += -run - 1;
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
        if (!(length_ > 0)) continue;
      }
      ended = all_above(depth, darkest);
      if (ended) return true;
      float x = part.zone ? middle : (base - seen.t) + middle;
      if (may_be_deep(part, length_)) {
        float half_length = 0.5 * length_;
        if (!march_deep_step(part, origin, direction, base + middle - half_length, x - half_length, length_, own))
          return false;
        if (ended) return true;
        continue;
      }
      if (!march_step(part, origin, direction, base + middle, x, length_, own)) return false;
    }
    at_step = 0;
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
