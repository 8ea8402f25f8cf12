// Light of one lamp that surfaces reflect towards the camera, the fog left out: `behind` of methods/wavelet_fog/wavelet_fog.cpp. The
// point is met again in double precision: the shadow ray starts there.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "raster/shadow_tree.glsl"
#include "common/loops_cut.glsl"
layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
layout(std430, binding = AT_TABLES) readonly buffer Tables { float tables[]; };              // of reflectances
#define MATERIALS_BINDING AT_MATERIALS
#include "common/reflection.glsl"
#include "wavelet_fog/lit.glsl"
#include "wavelet_fog/lamp.glsl"
uniform int first;     // the first of the lights
uniform double nudge;  // [m] off the surface, where shadow rays start

vec3 reflected_at(int primitive, dvec3 origin, dvec3 direction, out double t) {
  dvec3 normal, to_light;
  double distance_;
  int surface;
  t = meet_primitive(primitive, origin, direction, view_forward, normal, surface);
  if (surface < 0) return vec3(0);  // the ball of a light
  if (dot(normal, direction) > 0) normal = -normal;
  dvec3 point = origin + t * direction;
  vec3 irradiance = lamp_from(point, to_light, distance_);
  float cosine = float(dot(normal, to_light));
  if (!(cosine > 0) || irradiance == vec3(0)) return vec3(0);
  vec3 result = brdf(materials[surface], vec3(normal), vec3(to_light), vec3(-direction)) * cosine * irradiance;
  if (result == vec3(0)) return vec3(0);
  dvec3 start = point + nudge * normal;
  bool blocked = primitive_blocks(primitive, true, start, to_light, distance_) || tree_blocks(primitive, start, to_light, distance_);
  return blocked ? vec3(0) : result;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= view_width || at.y >= view_height) return;
  int place = at.y * view_width + at.x, primitive = primitive_of[place];
  dvec3 origin, direction;
  view_ray(dvec2(at) + 0.5LF, origin, direction);
  double t = 0;
  vec3 sum = first != 0 ? vec3(0) : lit[place].sum.rgb + lit[place].reflected.rgb, reflected = vec3(0);
  if (primitive >= 0) reflected = reflected_at(primitive, origin, direction, t);
  if (loops_cut()) reflected = vec3(uintBitsToFloat(0x7fc00000u));  // no number, rather than a wrong one
  lit[place] = Lit(vec4(reflected, 0), vec4(sum, 0), t, 0);
}
