// Extinction and scattering of media at a point of a camera ray: reference/lit_media. Places are relative to the media's middle.
//
//   vec3 extinction = lit_extinction(x);                                         // [1/m]; keeps the densities at x
//   for (int l = 0; l < lit_lights; ++l) source += lit_source(l, x, direction);  // [W/m^3/sr], of those densities
//
// A light at a point is as much as may be done at once: shadow rays of many lights through many triangles pass llvmpipe's limit on
// loops. `work` counts the iterations.
#include "common/angle.glsl"
#include "ray_marcher/layer.glsl"
#include "ray_marcher/light.glsl"
#include "ray_marcher/columns.glsl"
#if OCCLUDERS
#include "ray_marcher/occluders.glsl"
#endif

uniform int lit_lights;       // 0 where nothing scatters
uniform float lit_nearest;    // light comes from so far away at least [m]

// Work done by this invocation, as lit_media::Counters.
uint lit_points = 0, lit_look_ups = 0, lit_occlusion_rays = 0;

// The density of each layer at the point in question. It is in shared memory: private arrays make compilers spill registers.
const int lit_lanes = LOCAL_SIZE_X * LOCAL_SIZE_Y;
shared float lit_densities[LAYERS * lit_lanes];
#define LIT_DENSITY(k) lit_densities[(k) * lit_lanes + int(gl_LocalInvocationIndex)]

bool in_region(int k, vec3 x) {
  if (layers[k].shape == shape_everything) return true;
  vec3 o = to_local(layers[k].shape_frame, x);
  if (layers[k].shape == shape_box) return all(lessThanEqual(abs(o), layers[k].half_size));
  if (layers[k].shape == shape_slab) return abs(o.x) <= layers[k].half_size.x;
  return dot(o, o) <= 1;
}

vec3 lit_extinction(vec3 x) {
  vec3 extinction = vec3(0);
  work += uint(layer_count);
  for (int k = 0; k < layer_count; ++k) {
    float density = 0;
    if (in_region(k, x)) {
      density = layers[k].constant;
      if (layers[k].field != field_none) {
        vec3 o = to_local(layers[k].field_frame, x);
        if (all(greaterThanEqual(o, layers[k].lo)) && all(lessThanEqual(o, layers[k].hi))) {
          density += varied_density(k, x);
          ++lit_points;
        }
      }
    }
    LIT_DENSITY(k) = density;
    extinction += layers[k].sigma_t * density;
  }
  return extinction;
}

vec3 lit_source(int l, vec3 x, vec3 direction) {
  Light light = lights[l];
  vec3 to_light = light.axis, irradiance = light.colour;
  float distance_ = far_away;
  work += uint(layer_count);
  if (light.kind != light_directional) {
    vec3 offset = light.position - x;
    distance_ = max(length(offset), 1e-30);
    to_light = offset / distance_;
    float kept_off = max(distance_, lit_nearest);
    irradiance *= falloff(light, to_light) / (kept_off * kept_off);
  }
  vec3 less = to_light - direction, more = to_light + direction;
  float minus = 0.5 * dot(less, less), plus = 0.5 * dot(more, more);
  vec3 scattered = vec3(0);
  for (int k = 0; k < layer_count; ++k)
    scattered += layers[k].albedo * layers[k].sigma_t *
                 (LIT_DENSITY(k) * phase_value(layers[k].phase, layers[k].g, minus, plus));
  scattered *= irradiance;
#if OCCLUDERS
  if (scattered != vec3(0)) {
    ++lit_occlusion_rays;
    if (occluded(x, to_light, distance_)) scattered = vec3(0);
  }
#endif
#if DEPTHS == 2
  if (scattered != vec3(0)) {
    ++lit_look_ups;
    scattered *= exp(-depth_towards(l, x, to_light, distance_));
  }
#endif
  return scattered;
}

// The part [x, y] of a ray between where media begin and where they end; empty unless x < y.
vec2 lit_extent(vec3 origin, vec3 direction, vec2 t) {
  vec2 all_ = nothing;
  for (int k = 0; k < layer_count; ++k) {
    vec2 part = clip_region(k, origin, direction, t);
    if (part.x < part.y && layers[k].constant == 0) part = clip_field(k, origin, direction, part);
    if (part.x < part.y) all_ = vec2(min(all_.x, part.x), max(all_.y, part.y));
  }
  return all_;
}
