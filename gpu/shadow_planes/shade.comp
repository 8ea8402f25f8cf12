// Single scattering of one light, and what surfaces reflect of it, one pixel per invocation: Biri et al. 2006, section 5.1,
// stages 2 to 5; methods/shadow_planes/shadow_planes.cpp. SHADOWS: 0 none, 1 by counting, 2 a signed sum, 3 the paper's order
// and stencil; CROSSINGS: there are surfaces; AIRLIGHT: there is a medium; SURFACES: they reflect.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define STENCIL (SHADOWS == 3)
#include "raster/view.glsl"
#include "raster/primitive.glsl"
#include "shadow_planes/edge.glsl"
#include "shadow_planes/crossings.glsl"
#include "shadow_planes/airlight.glsl"

layout(std430, binding = 1) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
layout(std430, binding = 6) buffer Airlight { vec4 airlight[]; };
layout(std430, binding = 7) buffer Reflected { vec4 reflected[]; };
layout(std430, binding = 13) readonly buffer Counts { int count_at[]; };  // m where a ray begins, by pixel if not one for all
layout(std430, binding = 14) buffer Counters { uint counters[]; };        // lit parts, crossings, gatherings after the first
#if SURFACES
layout(std430, binding = 9) readonly buffer Tables { float tables[]; };
#include "common/reflection.glsl"
#endif
uniform int has_primitives, counts_per_pixel, tile_columns, frame_buffer;
uniform vec3 intensity;  // [W/sr], of a spot on its axis

shared uint part_sum, crossing_total, more_total;

vec3 airlight_of(Ray ray, double end, int tile, int m, out int m_end, out int parts, out int gatherings) {
  vec3 sum = vec3(0);
  parts = 0;
  gatherings = 1;
  m_end = m;
#if CROSSINGS
  last_key = -1e300LF;
  last_origin = -1;
  bool more = gather(ray, end, tile);
  m_end = m + crossing_sum;
#else
  bool more = false;
#endif
#if AIRLIGHT
#if SHADOWS == 0 || !CROSSINGS
  if (SHADOWS == 0 || m == 0) {
    sum = intensity * lit_airlight(ray, 0, end);
    parts = 1;
  }
#elif STENCIL
  // From the point that ends the ray to the eye, in the order of the middles of edges. Each plane adds or takes away all
  // light in front of it.
  int stencil = m_end;
  for (int e = -1;; ++e) {
    if (e >= hit_count) {
      if (!more) break;
      more = gather(ray, end, tile);
      ++gatherings;
      e = 0;
    }
    float share = 0;
    if (e < 0) {
      if (stencil == 0) share = 1;
    } else {
      if (hit_change[e] > 0 && stencil == hit_change[e]) share = 1;
      if (hit_change[e] < 0 && stencil == 0) share = -1;
      stencil = max(0, stencil - hit_change[e]);
    }
    if (share == 0) continue;
    ++parts;
    sum += share * intensity * lit_airlight(ray, 0, e < 0 ? end : hit_place[max(e, 0)]);
    if (frame_buffer != 0) sum = clamp(floor(sum * 255 + 0.5) / 255, vec3(0), vec3(1));
  }
#else
  double from = 0;
  for (int e = 0;; ++e) {
    if (e >= hit_count && more) {
      more = gather(ray, end, tile);
      ++gatherings;
      e = 0;
    }
    bool last = e >= hit_count;
    double to = last ? end : hit_key[min(e, most_hits - 1)];
    float share = SHADOWS == 1 ? (m == 0 ? 1 : 0) : 1 - 0.5 * float(m);
    if (to > from && share != 0) {
      sum += share * intensity * lit_airlight(ray, from, to);
      ++parts;
    }
    if (last) break;
    m += hit_change[e];
    from = to;
  }
#endif
#endif
  return sum;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (gl_LocalInvocationIndex == 0) part_sum = crossing_total = more_total = 0;
  barrier();
  if (pixel.x < view_width && pixel.y < view_height) {
    int place = pixel.y * view_width + pixel.x, primitive = has_primitives != 0 ? primitive_of[place] : -1, surface = -1;
    dvec3 origin, direction, normal = dvec3(0);
    view_ray(dvec2(pixel) + 0.5LF, origin, direction);
    double end = 1e37LF;
    if (primitive >= 0) end = meet_primitive(primitive, origin, direction, view_forward, normal, surface);
    Ray ray = ray_to(origin, direction);
    int m = count_at[counts_per_pixel != 0 ? place : 0], m_end, parts, gatherings;
    int tile = (pixel.y >> 4) * tile_columns + (pixel.x >> 4);
    airlight[place].rgb += airlight_of(ray, end, tile, m, m_end, parts, gatherings);
    atomicAdd(part_sum, uint(parts));
#if CROSSINGS
    atomicAdd(crossing_total, uint(crossing_count));
    atomicAdd(more_total, uint(gatherings - 1));
#endif
#if SURFACES
    if (surface >= 0 && m_end == 0) {
      if (dot(normal, direction) > 0) normal = -normal;
      dvec3 offset = ray.to_light - end * direction;
      double distance_ = length(offset);
      vec3 to_light = vec3(offset / distance_);
      float cosine = float(dot(normal, offset / distance_)), d = float(distance_);
#if SPOT
      double from_axis = -dot(offset / distance_, spot_axis);
      float factor = from_axis > cos_outer ? spot_factor(float(from_axis)) : 0;
#else
      float factor = 1;
#endif
      if (cosine > 0 && factor > 0)
        reflected[place].rgb += brdf(materials[surface], vec3(normal), to_light, vec3(-direction)) * cosine * factor *
                                intensity / (d * d) *
                                exp(-depth_along(origin + end * direction, offset / distance_, distance_));
    }
#endif
  }
  barrier();
  if (gl_LocalInvocationIndex == 0) {
    atomicAdd(counters[0], part_sum);
    atomicAdd(counters[1], crossing_total);
    atomicAdd(counters[2], more_total);
  }
}
