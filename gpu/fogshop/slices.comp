// Variant S: airlight and optical depth of every pixel of a strip, by K slices with exact depths at their edges. One tile
// is one work group. The steps and their names are those of methods/fogshop/ray_airlight.cpp and slices.cpp.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/near.glsl"
#include "fogshop/noise.glsl"
#include "fogshop/light.glsl"
#include "fogshop/light_lookup.glsl"

uniform int boxes, extrapolate;
uniform float clearest;  // least hue above 0

const float least_h = 1e-9;  // [m]
const int even_steps = K + K / 2;
const int light_steps = LIGHTS > 0 ? max(8, K / max(LIGHTS, 1)) : 0;
const int node_room = even_steps + 1 + LIGHTS * light_steps;

// The inner loops take eight at a time, so that llvmpipe's limit of 65535 iterations is far (passes.cpp watches it).
// Arrays have room for it: nodes and edges beyond the last are at its place, slices beyond the last are empty.
#define EIGHT_FROM(k, DO) DO(k) DO(k + 1) DO(k + 2) DO(k + 3) DO(k + 4) DO(k + 5) DO(k + 6) DO(k + 7)
const int node_space = (node_room + 7) / 8 * 8, slice_space = (K + 7) / 8 * 8;

float node[node_space], share[node_space];
float edge[slice_space + 1], view_depth[K + 1], depth_of_light[K + 1];
// Of the slices; not differences of view_depth, which lose the tails of the Gaussians.
float slice_depth[slice_space];
#if COLOURED
vec3 slice_scattering[slice_space];  // what the medium in the slice scatters, hue 1
#endif

// Optical depth of all Gaussians between two points.
float gaussian_depth(vec3 from, vec3 to) {
  float length_ = length(to - from), sum = 0;
  vec3 direction = length_ > 0 ? (to - from) / length_ : vec3(0, 0, 1);
  for (int i = 0; i < gaussian_count; ++i) {
    Crossing c = cross_line(gaussians[i], from, direction, length_);
    sum += depth_at(c, length_);  // whole: what lies beyond its radius counts, as on the CPU
  }
  return sum;
}

// Merges `light_steps` points at equal angles from the light into the nodes, of which there are `count`.
int add_even_angles(LightFromRay seen, float lo, float hi, int count) {
  float h = max(seen.h, least_h), xa = lo - seen.along, xb = hi - seen.along;
  float turn = angle_of(h * (hi - lo), h * h + xa * xb) / float(light_steps + 1), start = angle_of(xa, h);
  // From the last one down, each at the end of what is left: no second array.
  int from = count - 1, to = count + light_steps - 1;
  for (int k = light_steps; k >= 1; --k) {
    float angle = start + turn * float(k);
    float t = abs(angle) < 1.5707 ? clamp(seen.along + h * tan(angle), lo, hi) : (angle > 0 ? hi : lo);
    while (from >= 0 && node[from] > t) node[to--] = node[from--];
    node[to--] = t;
  }
  return count + light_steps;
}

// Per channel, from the slices whose edges are `stride` apart.
vec3 sum_slices(LightFromRay seen, int stride) {
  float h = max(length(vec2(seen.h, source_radius)), least_h);
  vec3 sum = vec3(0);
  for (int k = 0; k + stride <= K; k += stride) {
    float t0 = edge[k], t1 = edge[k + stride], length_ = t1 - t0;
    if (!(length_ > 0)) continue;
    float xa = t0 - seen.along, xb = t1 - seen.along;
    float mean_inverse_square = angle_of(h * length_, h * h + xa * xb) / (h * length_);
    float step_ = slice_depth[k];
    if (stride == 2) step_ += slice_depth[k + 1];
    float s0 = view_depth[k] + depth_of_light[k], s1 = view_depth[k + stride] + depth_of_light[k + stride];
    vec3 e0 = exp(-hue * s0), q = hue * (s1 - s0);
    vec3 series = 1 + q * (-0.5 + q * (1.0 / 6 + q * (-1.0 / 24 + q / 120)));
    for (int c = 0; c < 3; ++c) {
      float mean = abs(q[c]) < 0.1 ? e0[c] * series[c] : (e0[c] - exp(-hue[c] * s1)) / q[c];
#if COLOURED
      float scattered = slice_scattering[k][c];
      if (stride == 2) scattered += slice_scattering[k + 1][c];
#else
      float scattered = step_;
#endif
      sum[c] += mean_inverse_square * hue[c] * scattered * mean;
    }
  }
  return sum / (4 * pi);
}

// Of the Gaussians, from a light to a point.
float shadow_at(Light light, vec3 x) {
  return EXACT_LIGHT_DEPTH != 0 ? gaussian_depth(light.position, x) : light_depth(light, x);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tile_row * int(LOCAL_SIZE_Y));
  bool visible = is_computed(pixel);  // the others still help to load
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = visible ? ray_length(pixel) : far_away;
  int count = near_count();
  if (count < 0) return;  // the whole tile

  // Reach of the Gaussians, the light that they take away, the depth of the whole ray.
  float reach_lo = far_away, reach_hi = -far_away, opacity = 0, depth = 0;
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Crossing c = cross_view(near_block[i], origin, direction, end);
      if (!c.met) continue;
      reach_lo = min(reach_lo, c.middle - c.chord);
      reach_hi = max(reach_hi, c.middle + c.chord);
      opacity += 1 - exp(-2 * c.depth);
      depth += depth_at(c, end);
    }
  }
  if (constant > 0) depth += constant * end;

  float lo = max(reach_lo, 0), hi = min(reach_hi, end);
  if (constant > 0) {
    float beyond = max(0, reach_hi), dark = 0;
    for (int l = 0; l < LIGHTS; ++l) {
      LightFromRay seen = light_from_ray(lights[l], origin, direction);
      beyond = max(beyond, abs(seen.along) + seen.h);
      float d_sv = length(vec2(seen.along, seen.h)), c = d_sv + 40 / (constant * clearest);
      dark = max(dark, 0.5 * (c - d_sv) * (c + d_sv) / (c - seen.along));
    }
    lo = 0;
    hi = min(min(end, beyond * (1 + float(K) / 16)), dark);
  }
  bool sliced = visible && lo < hi && LIGHTS > 0;
  if (!sliced) lo = 0, hi = 1;  // the loads below are for all

  // Edges at equal steps of a mixture: even, even in angle for each light, even over the boxes of the Gaussians.
  int nodes = 0;
  for (; nodes <= even_steps; ++nodes) node[nodes] = lo + (hi - lo) * float(nodes) / float(even_steps);
  node[even_steps] = hi;
  for (int l = 0; l < LIGHTS; ++l) nodes = add_even_angles(light_from_ray(lights[l], origin, direction), lo, hi, nodes);
  for (int k = nodes; k < node_space; ++k) node[k] = hi, share[k] = 0;
  bool boxed = boxes != 0 && opacity > 0;
  float parts = 1 + (LIGHTS > 0 ? 1 : 0) + (boxed ? 1 : 0);
  for (int k = 0; k < nodes; ++k) share[k] = (node[k] - lo) / ((hi - lo) * parts);
  for (int l = 0; l < LIGHTS; ++l) {
    LightFromRay seen = light_from_ray(lights[l], origin, direction);
    float h = max(seen.h, least_h), xa = lo - seen.along, xb = hi - seen.along;
    float span = angle_of(h * (hi - lo), h * h + xa * xb);
    if (!(span > 0)) continue;
    for (int k = 0; k < nodes; ++k) {
      float x = node[k] - seen.along;  // the angle from `lo`, without cancelling
      share[k] += angle_of(h * (node[k] - lo), h * h + xa * x) / (span * parts * float(LIGHTS));
    }
  }
  if (boxes != 0)
    for (int first = 0; first < count; first += group_size) {
      int loaded = load_near(first, count);
      for (int i = 0; i < loaded; ++i) {
        Crossing c = cross_view(near_block[i], origin, direction, end);
        if (!c.met || !boxed) continue;
        float weight = (1 - exp(-2 * c.depth)) / (parts * opacity);
#define ADD_SHARE(k) share[k] += weight * clamp((node[k] - c.middle) * c.a / 3.2 + 0.5, 0, 1);
        for (int k = 0; k < nodes; k += 8) { EIGHT_FROM(k, ADD_SHARE) }
      }
    }
  float first_share = share[0], total = share[nodes - 1] - first_share;
  int at = 0;
  for (int i = 1; i < K; ++i) {
    float wanted = first_share + total * float(i) / float(K);
    while (at + 2 < nodes && share[at + 1] < wanted) ++at;
    float step_ = share[at + 1] - share[at];
    float s = step_ > 0 ? clamp((wanted - share[at]) / step_, 0, 1) : 0;
    edge[i] = node[at] + s * (node[at + 1] - node[at]);
  }
  edge[0] = lo;
  for (int k = K; k <= slice_space; ++k) edge[k] = hi;

  // Exact depths of the slices, and up to their edges.
  view_depth[0] = constant * edge[0];
  for (int k = 0; k < slice_space; ++k) slice_depth[k] = constant * (edge[k + 1] - edge[k]);
#if COLOURED
  for (int k = 0; k < slice_space; ++k) slice_scattering[k] = constant_colour * slice_depth[k];
#endif
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Crossing c = cross_view(near_block[i], origin, direction, end);
      if (!c.met) continue;
#if COLOURED
      vec3 colour = colour_of[int(near_block[i].place)].rgb;
#endif
      Place begin = place_at(c, edge[0]);
      view_depth[0] += c.depth * erf_between(c.start, begin);
      Place next;
      float part;
#if COLOURED
#define ADD_SCATTERING(k) slice_scattering[k] += colour * part;
#else
#define ADD_SCATTERING(k)
#endif
#define ADD_DEPTH(k)                             \
  next = place_at(c, edge[k + 1]);               \
  part = c.depth * erf_between(begin, next);     \
  slice_depth[k] += part;                        \
  ADD_SCATTERING(k)                              \
  begin = next;
      for (int k = 0; k < K; k += 8) { EIGHT_FROM(k, ADD_DEPTH) }
    }
  }
  for (int k = 0; k < K; ++k) view_depth[k + 1] = view_depth[k] + slice_depth[k];

  vec3 airlight = vec3(0);
  for (int l = 0; l < LIGHTS && sliced; ++l) {
    Light light = lights[l];
    LightFromRay seen = light_from_ray(light, origin, direction);
    float shadow = 0;
    for (int k = 0; k <= K; ++k) {
      shadow = shadow_at(light, origin + edge[k] * direction);
      depth_of_light[k] = shadow + constant * length(vec2(edge[k] - seen.along, seen.h));
    }
    vec3 sum = sum_slices(seen, 1);
    if (extrapolate != 0)
      sum = max(sum + (sum - sum_slices(seen, 2)) / 3, 0);
    if (constant > 0 && hi < end)
      sum += exp(-hue * (view_depth[K] + shadow)) *
             homogeneous_airlight(LightFromRay(seen.along - hi, seen.h), end - hi);
    airlight += light.intensity * sum;
  }
  if (visible) pixels[place_of(pixel)] = vec4(airlight * albedo, depth);
}
