// Single scattering of one light, and what surfaces reflect of it, one pixel per invocation: Biri et al. 2006, section 5.1,
// stages 2 to 5; methods/shadow_planes/shadow_planes.cpp. SHADOWS: 0 none, 1 by counting, 2 a signed sum, 3 the paper's order
// and stencil; STENCIL: in the paper's stages; CROSSINGS: there are surfaces; AIRLIGHT: there is a medium; SURFACES: they reflect.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "raster/primitive.glsl"
#include "shadow_planes/edge.glsl"
#include "shadow_planes/ray.glsl"
#include "shadow_planes/crossings.glsl"
#include "shadow_planes/airlight.glsl"
#include "common/loops_cut.glsl"
#include "shadow_planes/pixels.glsl"
#include "shadow_planes/state.glsl"

layout(std430, binding = 1) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
#if COUNT_BY_PIXEL
layout(std430, binding = 13) readonly buffer Counts { int count_at[]; };  // m where a ray begins
#endif
// lit parts, crossings, gatherings after the first; unfinished, loops cut
layout(std430, binding = 14) buffer Counters { uint counters[]; };
#if SURFACES
layout(std430, binding = 9) readonly buffer Tables { float tables[]; };
#include "common/reflection.glsl"
#endif
uniform int has_primitives, count_at_camera, frame_buffer;
uniform int reflects;  // light on surfaces is added once, not with every medium
uniform vec3 intensity;  // [W/sr], of a spot on its axis

shared uint part_sum, crossing_total, more_total;

#if STENCIL
#include "shadow_planes/stencil.glsl"
#else
#include "shadow_planes/lit_parts.glsl"
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (gl_LocalInvocationIndex == 0) part_sum = crossing_total = more_total = 0;
  barrier();
  int place = pixel.y * view_width + pixel.x;
  if (pixel.x < view_width && pixel.y < view_height && (resume == 0 || states[place].unfinished != 0)) {
    int primitive = has_primitives != 0 ? primitive_of[place] : -1, surface = -1;
    dvec3 origin, direction, normal = dvec3(0);
    view_ray(dvec2(pixel) + 0.5LF, origin, direction);
    double end = 1e37LF;
    if (primitive >= 0) end = meet_primitive(primitive, origin, direction, view_forward, normal, surface);
    Ray ray = ray_to(origin, direction);
    int m = count_at_camera, m_end, parts;
#if COUNT_BY_PIXEL
    m = count_at[place];
#endif
    State state = begin_state(place, m);
    if (frame_buffer != 0 && resume == 0) state.sum.rgb = lit_pixels[place].airlight.rgb;  // that of all lights
    vec3 in_air = airlight_of(ray, end, primitive, m, state, m_end, parts);
#if CROSSINGS
    states[place] = state;
    if (resume == 0) atomicAdd(crossing_total, uint(crossing_count));
    if (state.unfinished != 0) atomicAdd(more_total, 1);
#endif
    atomicAdd(part_sum, uint(parts));
    bool done = state.unfinished == 0;
    if (done) lit_pixels[place].airlight.rgb = in_air + (frame_buffer != 0 ? vec3(0) : lit_pixels[place].airlight.rgb);
#if SURFACES
    if (done && reflects != 0 && surface >= 0 && m_end == 0) {
      if (dot(normal, direction) > 0) normal = -normal;
      dvec3 offset = ray.to_light - end * direction;
      double distance_ = length(offset);
      vec3 to_light = vec3(offset / distance_);
      float cosine = float(dot(normal, offset / distance_)), d = float(distance_);
#if SPOT
      double from_axis = -dot(offset / distance_, spot_axis);
      float factor = from_axis > cos_outer ? spot_factor(float(1 - from_axis)) : 0;
#else
      float factor = 1;
#endif
      if (cosine > 0 && factor > 0)
        lit_pixels[place].reflected.rgb += brdf(materials[surface], vec3(normal), to_light, vec3(-direction)) * cosine * factor *
                                intensity / (d * d) *
                                exp(-depth_along(origin + end * direction, offset / distance_, distance_));
    }
#endif
  }
  if (loops_cut()) atomicOr(counters[4], 1);
  barrier();
  if (gl_LocalInvocationIndex == 0) {
    atomicAdd(counters[0], part_sum);
    atomicAdd(counters[1], crossing_total);
    atomicAdd(counters[2], more_total);
    atomicAdd(counters[3], more_total);
  }
}
