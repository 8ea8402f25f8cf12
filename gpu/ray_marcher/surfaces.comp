// Light that surfaces reflect towards the camera directly, through the media: lit_surface of reference/ray_marcher/scalar.h. One
// pixel per invocation, its lights in order, as many as a round allows. Points are met again in double precision: shadow rays
// start there.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define COUNT_NODE ++work;
#define MATERIALS_BINDING AT_MATERIALS
#include "ray_marcher/layer.glsl"
#include "raster/view.glsl"
#include "raster/shadow_tree.glsl"
#include "common/angle.glsl"
uniform int skip_empty;
uniform int light_count;
#include "ray_marcher/light.glsl"
#include "ray_marcher/columns.glsl"
#include "ray_marcher/pixel.glsl"
#include "ray_marcher/rounds.glsl"

layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
layout(std430, binding = AT_SURFACE) buffer Surface { float surface_layer[]; };
layout(std430, binding = AT_REFLECTANCES) readonly buffer Tables { float tables[]; };  // of reflectances
#include "common/reflection.glsl"
uniform int tile_columns, first_row;
uniform dvec3 middle;  // [m] of the marcher's places
uniform double nudge;  // [m] off the surface, where shadow rays start

uint shadow_ray_count = 0, occlusion_ray_count = 0;

// exp(-optical depth) from a point to a light, 0 behind a surface.
vec3 transmittance_to(int l, int own, dvec3 point, vec3 towards, dvec3 to_light, double distance_) {
  ++occlusion_ray_count;
  work += uint(solid_count);
  if (primitive_blocks(own, true, point, to_light, distance_) || tree_blocks(own, point, to_light, distance_)) return vec3(0);
  ++shadow_ray_count;
  return exp(-depth_towards(l, vec3(point - middle), towards, float(min(distance_, 1e37LF))));
}

// Light of one lamp, reflected by primitive `own` [W/m^2/sr].
vec3 reflected(int l, int own, Material material, dvec3 point, dvec3 normal, vec3 to_view) {
  Light light = lights[l];
  dvec3 to_light = dvec3(light.axis);
  double distance_ = 1e37LF;
  vec3 irradiance = light.colour;
  if (light.kind != light_directional) {
    dvec3 offset = middle + dvec3(light.position) - point;
    distance_ = length(offset);
    if (!(distance_ > 0)) return vec3(0);
    to_light = offset / distance_;
    float d = float(distance_);
    irradiance *= falloff(light, vec3(to_light)) / (d * d);
  }
  float cosine = float(dot(normal, to_light));
  if (!(cosine > 0) || irradiance == vec3(0)) return vec3(0);
  vec3 towards = vec3(to_light), result = brdf(material, vec3(normal), towards, to_view) * cosine * irradiance;
  if (result == vec3(0)) return vec3(0);
  return result * transmittance_to(l, own, point + nudge * normal, towards, to_light, distance_);
}

void main() {
  int tile = tile_of_group();
  ivec2 at = ivec2(tile % tile_columns, tile / tile_columns) * ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y) +
             ivec2(gl_LocalInvocationID.xy);
  int place = at.y * view_width + at.x;
  at.y += first_row;
  if (at.x >= view_width || at.y >= view_height) return;
  int film_place = at.y * view_width + at.x, primitive = primitive_of[film_place];
  vec3 sum = vec3(0), through = vec3(1);
  int light = 0;
#if LAYERS
  through = pixels[place].transmittance;
#endif
  if (round_ > 0) {
    light = pixels[place].light;
    if (light >= light_count) return;
    for (int c = 0; c < 3; ++c) sum[c] = surface_layer[3 * film_place + c];
  }
  dvec3 origin, direction, normal = dvec3(0);
  view_ray(dvec2(at) + 0.5LF, origin, direction);
  int surface = -1;
  double t = 0;
  if (primitive >= 0) t = meet_primitive(primitive, origin, direction, view_forward, normal, surface);
  if (surface < 0 || through == vec3(0)) light = light_count;  // the ball of a light reflects nothing
  if (dot(normal, direction) > 0) normal = -normal;
  bool moved = false;
  for (; light < light_count && !(moved && work > uint(budget)); ++light) {
    work += 8u;
    sum += through * reflected(light, primitive, materials[surface], origin + t * direction, normal, vec3(-direction));
    moved = true;
  }
  for (int c = 0; c < 3; ++c) surface_layer[3 * film_place + c] = sum[c];
  pixels[place].light = light;
#if LAYERS
  pixels[place].shadow_rays += shadow_ray_count;
  pixels[place].shadow_steps += shadow_step_count;
  pixels[place].occlusion_rays += occlusion_ray_count;
#else
  pixels[place].shadow_rays = (round_ > 0 ? pixels[place].shadow_rays : 0u) + shadow_ray_count;
  pixels[place].occlusion_rays = (round_ > 0 ? pixels[place].occlusion_rays : 0u) + occlusion_ray_count;
#endif
  if (light < light_count) leave_to_next_round(tile);
}
