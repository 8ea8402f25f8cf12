// Light of a sun that the fog scatters once towards the camera, a ray per invocation: SunScattering of
// methods/wavelet_fog/sun_scattering.cpp. A ray stops when it has done its share of loops, or its shadows are not known any farther, and
// goes on in the next dispatch.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
uint work = 0u;
#define COUNT_LOOP ++work;
#define SUN_MAP_ACCESS readonly
#define VALUES_ACCESS readonly
#include "raster/view.glsl"
#include "wavelet_fog/grids.glsl"
#include "wavelet_fog/fog.glsl"
#include "wavelet_fog/walk.glsl"
#include "wavelet_fog/sun_map.glsl"
#include "wavelet_fog/sun_column.glsl"
#include "wavelet_fog/sun_course.glsl"
#include "wavelet_fog/sun_ray.glsl"
#include "common/loops_cut.glsl"
layout(std430, binding = AT_AIRLIGHT) buffer AirlightLayer { float airlight_layer[]; };
layout(std430, binding = AT_COUNTERS) buffer Counters { uint counters[]; };
uniform int first, counts;       // first: of the suns
uniform int budget;              // iterations of loops, about
uniform int mark;                // left in counters[9] by rays that are to be gone on with; 0: not asked for
uniform float least;             // transmittance at which a ray ends
uniform vec3 scattered[MEDIA];   // albedo sigma_t E [W/m^3]
uniform int phase_kind[MEDIA];
uniform float phase_g[MEDIA], climb;  // climb: scale heights per metre upwards, of the steepest medium

const float sun_node[SUN_POINTS] = float[](SUN_NODES), sun_weight[SUN_POINTS] = float[](SUN_WEIGHTS);
const float upto[SUN_POINTS * SUN_POINTS] = float[](SUN_UPTO);  // [node][term]: integral from 0 to the node
const float opaque = 40, most_change = 0.5;
const int most_halvings = 12, most_deep_halvings = 30;  // `index` is a whole number of 32 bits

vec3 source_of[MEDIA];  // per density
vec3 depth, light;
uint points_done = 0u;
vec3 extinction[SUN_POINTS], scattering[SUN_POINTS], to_sun[SUN_POINTS];  // at the points of a piece

float phase_of(double c, int kind, float g) {  // per steradian
  const float per_sphere = 0.0795774715459477;
  float v = float(0.5LF * (1 + c)), w = float(0.5LF * (1 - c));
  if (kind == PHASE_RAYLEIGH) return per_sphere * 0.75 * (1 + (v - w) * (v - w));
  if (kind == PHASE_HENYEY_GREENSTEIN) {
    float d = g > 0 ? (1 - g) * (1 - g) + 4 * g * w : (1 + g) * (1 + g) - 4 * g * v;
    return per_sphere * (1 - g) * (1 + g) / (d * sqrt(d));
  }
  float p = v * v;
  p *= p, p *= p;
  if (kind == PHASE_HAZY) return per_sphere * 0.5 * (1 + 9 * p);
  p *= p, p *= p;
  return kind == PHASE_MURKY ? per_sphere * (33.0 / 83.0) * (1 + 50 * p) : per_sphere;
}

// The medium in hand at the points from t.x to t.y, of a cell around `middle`.
void add_medium(dvec2 t, double middle, bool lit) {
  vec3 sigma = vec3(fog.sigma_t[0], fog.sigma_t[1], fog.sigma_t[2]);
  ivec2 cell = cell_of(middle);
  bool there = is_in_medium(middle) && empty_around(grids[fog.cells], cell) < 0;
  if (!there && !lit) return;
  Grid g = grids[fog.map];
  Cell c = Cell(0);
  if (there) c = cell_at(place_of(g, cell), g.stride);
  Line line = Line(dvec2(0), dvec2(0), course_origin.y + middle * course_direction.y, 0);
  int below = knots_below(line);
  line = Line(dvec2(0), dvec2(0), course_origin.y, course_direction.y);
  Factor factor = factor_between(line, below);
  for (int k = 0; k < SUN_POINTS; ++k) {
    ++work;
    double here = t.x + double(sun_node[k]) * (t.y - t.x);
    if (there) {
      float h = float(factor.value + here * factor.slope);
      if (PROFILE == PROFILE_EXPONENTIAL && factor.falls)
        h = exp(-float((course_origin.y + here * course_direction.y - FALL_BASE) / FALL_SCALE));
      float density = max(in_cell(c, vec2(from_bits(start_in[medium]) + here * from_bits(along_in[medium]) - dvec2(cell))) * h, 0);
      extinction[k] += sigma * density;
      scattering[k] += source_of[medium] * density;
    }
    // Without end it is infinite, and no light comes.
    if (lit) to_sun[k] += sigma * min(sun_column(course_origin + here * course_direction), 1e30);
  }
}

bool has_ended() { return !(exp(-min(depth.x, min(depth.y, depth.z))) > least); }

// A piece of a cell without edge of a shadow; halved where an optical depth changes much. False: to be gone on with.
bool scatter(dvec2 t, bool lit, inout int halvings, inout int index) {
  do {
    if (has_ended()) return true;
    if (work > uint(budget)) return false;
    ++work;
    double length_ = (t.y - t.x) * double(exp2(float(-halvings))), start = t.x + double(index) * length_;
    for (int k = 0; k < SUN_POINTS; ++k) extinction[k] = scattering[k] = to_sun[k] = vec3(0);
    for (int i = 0; i < media; ++i) {
      ++work;
      take_medium(i);
      add_medium(dvec2(start, start + length_), 0.5LF * (t.x + t.y), lit);
    }
    vec3 total = vec3(0), low = vec3(1e37), high = vec3(0);
    float s = float(length_);
    for (int k = 0; k < SUN_POINTS; ++k) {
      total += s * sun_weight[k] * extinction[k];
      low = min(low, to_sun[k]);
      high = max(high, to_sun[k]);
    }
    points_done += uint(SUN_POINTS);
    bool deep = max(total.x, max(total.y, total.z)) > most_change;
    bool coarse = deep || climb * abs(float(course_direction.y)) * s > 1;
    for (int a = 0; a < 3; ++a) coarse = coarse || (lit && low[a] < opaque && high[a] - low[a] > most_change);
    if (coarse && halvings < (deep ? most_deep_halvings : most_halvings)) {
      ++halvings;
      index *= 2;
      continue;
    }
    for (int k = 0; k < SUN_POINTS && lit; ++k) {
      work += uint(SUN_POINTS);
      vec3 before = depth + to_sun[k];
      for (int term = 0; term < SUN_POINTS; ++term) before += s * upto[k * SUN_POINTS + term] * extinction[term];
      light += s * sun_weight[k] * scattering[k] * exp(-before);
    }
    depth += total;
    ++index;
    while (halvings > 0 && (index & 1) == 0) {
      index /= 2;
      --halvings;
    }
  } while (halvings > 0);
  index = 0;
  return true;
}

// Marches as far as shadows are known. Returns false if the ray must be continued.
bool march(int place, inout SunState ray) {
  while (ray.from < ray.end) {
    if (has_ended()) return true;
    if (work > uint(budget)) return false;
    ++work;
    bool to_edge = ray.read < ray.edges;
    double next = min(next_cut(ray.from), ray.end), edge = 1e37LF;
    if (to_edge) edge = sun_rays[place].edge[ray.read];
    if (!to_edge && next > ray.known) return false;
    double to = min(next, edge);
    bool lit = (ray.flags & lit_here) != 0;
    if (to > ray.from && something_at(0.5LF * (ray.from + to)) && !scatter(dvec2(ray.from, to), lit, ray.halvings, ray.index))
      return false;
    ray.from = max(ray.from, to);
    if (!(edge > next)) {
      ++ray.read;
      ray.flags ^= lit_here;
    }
  }
  return true;
}

shared uint points_of_group, shadow_rays_of_group;
void add_to_counter(int low, uint amount) {
  if (atomicAdd(counters[low], amount) > 0xffffffffu - amount) atomicAdd(counters[low + 1], 1u);
}

void main() {
  ivec2 pixel;
  int place = ray_in_hand(pixel);
  if (gl_LocalInvocationIndex == 0u) points_of_group = shadow_rays_of_group = 0u;
  uint shadow_rays = 0u;
  if (place >= 0 && sun_rays[place].state.from < 1e37LF) {
    SunState ray = sun_rays[place].state;
    dvec3 origin, direction;
    view_ray(dvec2(pixel) + 0.5LF, origin, direction);
    set_course(origin, direction, ray.end);
    double c = dot(dvec3(sun_x, sun_y, sun_z), direction);
    for (int i = 0; i < media; ++i) source_of[i] = scattered[i] * phase_of(c, phase_kind[i], phase_g[i]);
    light = vec3(ray.light[0], ray.light[1], ray.light[2]);
    depth = vec3(ray.depth[0], ray.depth[1], ray.depth[2]);
    if (march(place, ray)) {
      ray.from = 1e37LF;
      shadow_rays = uint(ray.shadow_rays);
      int to = 3 * (pixel.y * view_width + pixel.x);
      for (int c = 0; c < 3; ++c) airlight_layer[to + c] = light[c] + (first != 0 ? 0 : airlight_layer[to + c]);
    } else if (mark != 0) {
      counters[9] = uint(mark);
    }
    for (int c = 0; c < 3; ++c) ray.light[c] = light[c], ray.depth[c] = depth[c];
    if (counts != 0 && (loops_cut() || (ray.flags & cut_short) != 0)) counters[4] = 1u;
    sun_rays[place].state = ray;
  }
  if (counts == 0) return;
  barrier();
  atomicAdd(points_of_group, points_done);
  atomicAdd(shadow_rays_of_group, shadow_rays);
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  add_to_counter(5, points_of_group);
  add_to_counter(10, shadow_rays_of_group);
}
