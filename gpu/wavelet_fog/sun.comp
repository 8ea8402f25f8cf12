// Light of a sun that the fog scatters once towards the camera, a ray per invocation: SunScattering of
// methods/wavelet_fog/sun_scattering.cpp, with one medium and nothing that stands in the way.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define SUN_MAP_ACCESS readonly
#define VALUES_ACCESS readonly
#include "raster/view.glsl"
#include "wavelet_fog/grids.glsl"
#include "wavelet_fog/fog.glsl"
#include "wavelet_fog/walk.glsl"
#include "wavelet_fog/sun_map.glsl"
#include "wavelet_fog/sun_column.glsl"
#include "common/loops_cut.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
layout(std430, binding = AT_AIRLIGHT) buffer AirlightLayer { float airlight_layer[]; };
layout(std430, binding = AT_COUNTERS) buffer Counters { uint counters[]; };
uniform int has_distances, first, counts;
uniform float least;   // transmittance at which a ray ends
uniform vec3 scattered;  // albedo sigma_t E [W/m^3]
uniform int phase_kind;
uniform float phase_g;

const float sun_node[SUN_POINTS] = float[](SUN_NODES), sun_weight[SUN_POINTS] = float[](SUN_WEIGHTS);
const float upto[SUN_POINTS * SUN_POINTS] = float[](SUN_UPTO);  // [node][term]: integral from 0 to the node
const float opaque = 40, most_change = 0.5;
const int most_halvings = 12;
// Farther than in walk.glsl: where a walk begins anew it cuts a cell in two, which the rule of a cell tells.
const double cells_of_a_walk = 128;

float column_so_far = 0;
vec3 light = vec3(0);
uint points_done = 0u;

float phase_of(double c) {  // per steradian
  const float per_sphere = 0.0795774715459477;
  float v = float(0.5LF * (1 + c)), w = float(0.5LF * (1 - c)), g = phase_g;
  if (phase_kind == PHASE_RAYLEIGH) return per_sphere * 0.75 * (1 + (v - w) * (v - w));
  if (phase_kind == PHASE_HENYEY_GREENSTEIN) {
    float d = g > 0 ? (1 - g) * (1 - g) + 4 * g * w : (1 + g) * (1 + g) - 4 * g * v;
    return per_sphere * (1 - g) * (1 + g) / (d * sqrt(d));
  }
  float p = v * v;
  p *= p, p *= p;
  if (phase_kind == PHASE_HAZY) return per_sphere * 0.5 * (1 + 9 * p);
  p *= p, p *= p;
  return phase_kind == PHASE_MURKY ? per_sphere * (33.0 / 83.0) * (1 + 50 * p) : per_sphere;
}

// A piece of a cell, s from x to y behind the anchor at t; halved where an optical depth changes much. False: the ray has ended.
bool scatter_in_cell(Cell c, vec2 at, vec2 along, vec2 s, double t, Line line, Factor factor, dvec3 origin, dvec3 direction) {
  vec3 sigma = vec3(sigma_t[0], sigma_t[1], sigma_t[2]);
  float thickest = max(sigma.x, max(sigma.y, sigma.z)), thinnest = min(sigma.x, min(sigma.y, sigma.z)), climb = 0;
#if PROFILE == PROFILE_EXPONENTIAL
  float height = float((line.height + t * line.rise - FALL_BASE) / FALL_SCALE), fall = float(line.rise / FALL_SCALE);
  climb = abs(fall);
#endif
  float density[SUN_POINTS], column[SUN_POINTS];
  int halvings = 0, index = 0;
  do {
    if (!(exp(-thinnest * column_so_far) > least)) return false;
    float length_ = (s.y - s.x) * exp2(float(-halvings)), start = s.x + float(index) * length_;
    float total = 0, low = 1e37, high = 0;
    for (int k = 0; k < SUN_POINTS; ++k) {
      float here = start + sun_node[k] * length_, h = 1;
#if PROFILE == PROFILE_LAYERS
      h = float(factor.value + (t + here) * factor.slope);
#elif PROFILE == PROFILE_EXPONENTIAL
      h = factor.falls ? exp(-(height + here * fall)) : float(factor.value);
#endif
      density[k] = max(in_cell(c, at + here * along) * h, 0);
      column[k] = sun_column(origin + (t + here) * direction);
      total += length_ * sun_weight[k] * density[k];
      low = min(low, column[k]);
      high = max(high, column[k]);
    }
    points_done += uint(SUN_POINTS);
    bool coarse = thickest * total > most_change || climb * length_ > 1;
    for (int a = 0; a < 3; ++a) coarse = coarse || (sigma[a] * low < opaque && sigma[a] * (high - low) > most_change);
    if (coarse && halvings < most_halvings) {
      ++halvings;
      index *= 2;
      continue;
    }
    for (int k = 0; k < SUN_POINTS; ++k) {
      float before = column_so_far + column[k];
      for (int term = 0; term < SUN_POINTS; ++term) before += length_ * upto[k * SUN_POINTS + term] * density[term];
      light += length_ * sun_weight[k] * density[k] * exp(-sigma * before);
    }
    column_so_far += total;
    ++index;
    while (halvings > 0 && (index & 1) == 0) {
      index /= 2;
      --halvings;
    }
  } while (halvings > 0);
  return true;
}

// As walk() and integral_of of walk.glsl, which cannot call back. False: the ray has ended.
bool scatter_from(Line line, double t, float end, Factor factor, dvec3 origin, dvec3 direction) {
  Grid g = grids[0], all = grids[cells];
  dvec2 exact = line.start + t * line.along, corner = floor(exact);
  ivec2 anchor = ivec2(corner), last = lo_of(g) + size_of(g) + DEGREE - 1;
  vec2 at = vec2(exact - corner), along = vec2(line.along), towards = sign(along);
  vec2 next = mix(ceil(at) - 1, floor(at) + 1, greaterThan(along, vec2(0)));
  vec2 met = vec2(crossing(at.x, along.x, next.x), crossing(at.y, along.y, next.y));
  float s = 0;
  while (s < end) {
    float to = min(min(met.x, met.y), end);
    if (to > s) {
      ivec2 cell = clamp(anchor + ivec2(floor(at + 0.5 * (s + to) * along)), lo_of(g), last), index = cell - lo_of(all);
      uint empty = emptiness[index.y * words_in_row(all) + index.x / 8] >> (4 * (index.x & 7)) & 15u;
      if (empty == 0u && !scatter_in_cell(cell_at(place_of(g, cell), g.stride), at - vec2(cell - anchor), along, vec2(s, to), t, line,
                                          factor, origin, direction))
        return false;
      s = to;
    }
    if (met.x <= s) next.x += towards.x, met.x = crossing(at.x, along.x, next.x);
    if (met.y <= s) next.y += towards.y, met.y = crossing(at.y, along.y, next.y);
  }
  return true;
}
void scatter(Line line, dvec2 way, dvec3 origin, dvec3 direction) {
  int level_below = 0;
  bool rises = line.rise != 0, goes_on = true;
  for (int k = 0; k < breaks() && !rises; ++k)
    if (knot_height(k) < line.height || (PROFILE == PROFILE_LAYERS && knot_height(k) == line.height)) level_below = k + 1;
  for (int k = 0; k <= (rises ? breaks() : 0) && goes_on; ++k) {
    dvec2 part = way;
    int below = !rises ? level_below : line.rise > 0 ? k : breaks() - k;
    if (rises) {
      double lo = below > 0 ? knot_height(below - 1) : -1e37LF, hi = below < breaks() ? knot_height(below) : 1e37LF;
      part = clip_axis(line.height, line.rise, lo, hi, way);
    }
    if (!(part.y > part.x)) continue;
    Factor factor = factor_between(line, below);
    if (factor.value == 0 && factor.slope == 0) continue;
    double length_ = part.y - part.x;
    double spans = max(1.0LF, ceil((abs(line.along.x) + abs(line.along.y)) * length_ / cells_of_a_walk));
    for (double i = 0; i < spans && goes_on; ++i)
      goes_on = scatter_from(line, part.x + length_ * (i / spans), float(length_ / spans), factor, origin, direction);
  }
}

shared uint points_of_group;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  bool inside = at.x < view_width && at.y < view_height;
  if (gl_LocalInvocationIndex == 0u) points_of_group = 0u;
  if (inside) {
    int place = at.y * view_width + at.x;
    dvec3 origin, direction, to_sun = dvec3(sun_x, sun_y, sun_z);
    view_ray(dvec2(at) + 0.5LF, origin, direction);
    Line line = line_over(origin, direction);
    double end = has_distances != 0 ? double(distances[place]) : 1e37LF;
    dvec2 way = clip_to_support(grids[0], line, clip_to_region(origin, direction, dvec2(0, end)));
    if (way.y > way.x) scatter(line, way, origin, direction);
    vec3 result = scattered * light * phase_of(dot(to_sun, direction));
    for (int c = 0; c < 3; ++c) airlight_layer[3 * place + c] = result[c] + (first != 0 ? 0 : airlight_layer[3 * place + c]);
    if (counts != 0 && loops_cut()) counters[4] = 1u;
  }
  if (counts == 0) return;
  barrier();
  atomicAdd(points_of_group, points_done);
  barrier();
  if (gl_LocalInvocationIndex == 0u && atomicAdd(counters[5], points_of_group) > 0xffffffffu - points_of_group)
    atomicAdd(counters[6], 1u);
}
