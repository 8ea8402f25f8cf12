// Single scattering of one light, and what surfaces reflect of it, one pixel per invocation: Biri et al. 2006, section 5.1,
// stages 2 to 5; methods/shadow_planes/shadow_planes.cpp. SHADOWS: 0 none, 1 by counting, 2 a signed sum, 3 the paper's order
// and stencil; STENCIL: in the paper's stages; CROSSINGS: there are surfaces; AIRLIGHT: there is a medium; SURFACES: they reflect.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "raster/primitive.glsl"
#include "shadow_planes/edge.glsl"
#include "shadow_planes/light_state.glsl"
#include "shadow_planes/ray.glsl"
#if CROSSINGS
#include "shadow_planes/crossings.glsl"
#else
const int hit_count = 0;
#endif
#include "shadow_planes/airlight.glsl"
#include "common/loops_cut.glsl"
#include "shadow_planes/counters.glsl"
#include "shadow_planes/pixels.glsl"
#include "shadow_planes/state.glsl"

layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
#if SURFACES
layout(std430, binding = AT_TABLES) readonly buffer Tables { float tables[]; };
#include "common/reflection.glsl"
#endif
uniform int has_primitives, frame_buffer;
uniform int reflects;   // light on surfaces is added once, not with every medium
uniform int adds;       // to what other lights left; 0: the first of a picture
uniform int next_groups;  // which of resume_groups are the next dispatch's
uniform vec3 intensity;  // [W/sr], of a spot on its axis

shared uint part_sum, crossing_total, gathering_total;
shared bool unfinished_here;

// Does the ray meet something that scatters?
bool meets_air(Line line, double end) {
#if !AIRLIGHT
  return false;
#elif PAPER_MEDIUM
  dvec2 part = domain_of(line, end);
  return part.y > part.x;
#elif BOUNDED
  bool met = false;
  for (int m = 0; m < media_count; ++m) {
    dvec2 inside = clip_to_region(m, line.origin, line.direction, dvec2(0, end));
    met = met || (inside.y > inside.x && any(greaterThan(albedo_of(m) * extinction_of(m), vec3(0))));
  }
  return met;
#else
  return true;
#endif
}

#if STENCIL
#include "shadow_planes/stencil.glsl"
#else
#include "shadow_planes/lit_parts.glsl"
#endif

#if SURFACES
// Light that a surface reflects, without the loss on the way to the eye.
vec3 reflected_light(Line line, double end, int surface, dvec3 normal) {
  if (dot(normal, line.direction) > 0) normal = -normal;
  dvec3 offset = light - line.origin - end * line.direction;
  double distance_ = length(offset);
  dvec3 to_light = offset / distance_;
  float cosine = float(dot(normal, to_light)), d = float(distance_), factor = 1;
#if SPOT
  double from_axis = -dot(to_light, spot_axis);
  factor = from_axis > cos_outer ? spot_factor(float(1 - from_axis)) : 0;
#endif
  if (!(cosine > 0 && factor > 0)) return vec3(0);
  return brdf(materials[surface], vec3(normal), vec3(to_light), vec3(-line.direction)) * cosine * factor * intensity / (d * d) *
         exp(-depth_along(line.origin + end * line.direction, to_light, distance_));
}
#endif

void shade(ivec2 pixel, int place) {
  int primitive = has_primitives != 0 ? primitive_of[place] : -1, surface = -1;
  dvec3 normal = dvec3(0);
  Line line;
  view_ray(dvec2(pixel) + 0.5LF, line.origin, line.direction);
#if CROSSINGS && !COUNT_BY_PIXEL
  line.origin = view_position;  // what it is, and takes no registers
#endif
  double end = 1e37LF;
  if (primitive >= 0) end = meet_primitive(primitive, line.origin, line.direction, view_forward, normal, surface);
  vec3 reflected = vec3(0);  // if m is 0 there: computed first, so that normals need not be kept
#if SURFACES
  if (reflects != 0 && surface >= 0) reflected = reflected_light(line, end, surface, normal);
#endif
  int m = 0, m_end;
#if COUNT_BY_PIXEL
  m = states[place].m_origin;
#elif CROSSINGS
  m = count_at_camera;
#endif
  Work work;
  State state = begin_state(place, m);
  if (frame_buffer != 0 && resume == 0 && adds != 0) state.sum.rgb = lit_pixels[place].airlight.rgb;  // airlight of all lights so far
  vec3 in_air = airlight_of(line, end, primitive, m, state, m_end, work);
#if CROSSINGS
  if (resume == 0) atomicAdd(crossing_total, uint(work.crossings));
  if (work.gatherings != 0) atomicAdd(gathering_total, uint(work.gatherings));
  states[place].unfinished = state.unfinished;
  if (state.unfinished != 0) {
    states[place] = state;
    unfinished_here = true;
  }
#endif
  atomicAdd(part_sum, uint(work.parts));
  if (state.unfinished != 0) return;
  LitPixel lit = LitPixel(vec4(0), vec4(0));
  if (adds != 0) lit = lit_pixels[place];
  lit.airlight.rgb = in_air + (frame_buffer != 0 ? vec3(0) : lit.airlight.rgb);
  if (m_end == 0) lit.reflected.rgb += reflected;
  lit_pixels[place] = lit;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (gl_LocalInvocationIndex == 0) part_sum = crossing_total = gathering_total = 0, unfinished_here = false;
  barrier();
  int place = pixel.y * view_width + pixel.x;
  if (pixel.x < view_width && pixel.y < view_height && (resume == 0 || states[place].unfinished != 0)) shade(pixel, place);
  if (loops_cut()) atomicOr(loops_were_cut, 1);
  barrier();
  if (gl_LocalInvocationIndex == 0) {
    atomicAdd(lit_parts, part_sum);
    atomicAdd(crossings, crossing_total);
    atomicAdd(gatherings_after_first, gathering_total);
    if (unfinished_here) resume_groups[next_groups] = uvec4(gl_NumWorkGroups, 0);
  }
}
