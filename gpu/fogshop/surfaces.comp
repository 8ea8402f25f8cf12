// Surfaces seen through the medium: Zhou et al. 2007, Eq. 29 with L_p by Eqs. 19 to 27, every pixel that a surface ends
// (methods/fogshop/surface_pass.cpp, surface_lighting.cpp). Points are met again in double precision: shadows start there.
// HARMONICS: light or reflectance in harmonics of SH_ORDER bands; SUN: what points scatter without them; TRANSFER: shadows of
// what is in harmonics; ENVIRONMENT: light of one, DEPTH_TREE: through average depths by a tree.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "raster/shadow_tree.glsl"
#include "common/loops_cut.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/light.glsl"
#include "fogshop/light_lists.glsl"
#include "fogshop/average_depth.glsl"

layout(std430, binding = AT_SURFACE_TABLES) readonly buffer Tables { float tables[]; };  // all that is precomputed, one after the other
layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
layout(std430, binding = AT_LIGHT_PLACES) readonly buffer LightPlaces { double light_place[]; };  // [m], not rounded: maps start there
layout(std430, binding = AT_PIXELS) readonly buffer Pixels { vec4 pixels[]; };           // airlight, depth
layout(std430, binding = AT_SURFACE) writeonly buffer Surface { float surface_layer[]; };
layout(std430, binding = AT_SCATTERED) writeonly buffer Scattered { float scattered_layer[]; };
uniform int has_airlight, has_scattered;
uniform float environment_depth;  // of the constant up to the environment [-]
#include "common/reflection.glsl"
#if DEPTH_TREE
#include "fogshop/depth_tree.glsl"
#endif
#if HARMONICS
#include "fogshop/harmonics.glsl"
#endif
#if SUN
#include "fogshop/sun.glsl"
#endif
uniform double nudge;       // [m] off the surface, where shadow rays start
uniform int casts_shadows;  // 0: each surface shadows at most itself

bool in_shadow(int own, dvec3 point, dvec3 to_light, double end) {
  return primitive_blocks(own, true, point, to_light, end) ||
         (casts_shadows != 0 && tree_blocks(own, point, to_light, end));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool within_film = pixel.x < view_width && pixel.y < view_height;
  int place = within_film ? pixel.y * view_width + pixel.x : 0, primitive = within_film ? primitive_of[place] : -1, surface = -1;
  vec3 direct = vec3(0), scattered = vec3(0), n = vec3(0), to_view = vec3(0);
  dvec3 point = dvec3(0), normal = dvec3(0);
  if (primitive >= 0) {
    dvec3 origin, direction;
    view_ray(dvec2(pixel) + 0.5LF, origin, direction);
    double t = meet_primitive(primitive, origin, direction, view_forward, normal, surface);
    // Not on the ball of a light, and not on what reflects nothing.
    if (surface >= 0 && !any(greaterThan(materials[surface].diffuse.rgb + materials[surface].specular.rgb, vec3(0)))) surface = -1;
    if (dot(normal, direction) > 0) normal = -normal;
    point = origin + t * direction;
    n = vec3(normal);
    to_view = vec3(-direction);
  }
  bool lit = surface >= 0;
  Material material = materials[max(surface, 0)];
#if HARMONICS
  Reflected reflected = reflectance_of(material, n, to_view);
#if TRANSFER
  if (lit) {
    turn_reflectance(reflected);
    vec3 diffuse = material.diffuse.w == 2 ? vec3(0) : material.diffuse.rgb;  // of a table nothing is known to be
    if (primitive >= triangle_count || !shadow_reflectance(reflected, diffuse, triangles[primitive], point, normal))
      keep_reflectance(reflected);
  }
#endif
#endif
  for (int l = 0; l < light_count; ++l) {
    bool wanted = false;
    float d = 0, cosine = 0;
    vec3 towards = vec3(0), reflectance = vec3(0);
    if (lit) {
      dvec3 offset = dvec3(light_place[3 * l], light_place[3 * l + 1], light_place[3 * l + 2]) - point;
      double distance_ = length(offset);
      if (distance_ > 0) {
        dvec3 to_light = offset / distance_;
        d = float(distance_);
        cosine = float(dot(normal, to_light));
        towards = vec3(to_light);
        if (cosine > 0) {
          reflectance = brdf(materials[surface], n, towards, to_view);  // read again: it would take registers in the tree
          if (any(greaterThan(reflectance, vec3(0))) && in_shadow(primitive, point + nudge * normal, to_light, distance_))
            reflectance = vec3(0);
        }
        wanted = has_scattered != 0 || any(greaterThan(reflectance, vec3(0)));
      }
    }
    float depth = depth_from_light(l, wanted, vec3(point)) + constant * d;
    if (wanted) {
      vec3 irradiance = lights[l].intensity / (d * d);
      direct += reflectance * cosine * irradiance * decay(depth);
#if SUN
      scattered += irradiance * reflect_sun(material, n, to_view, towards, depth * extinction_ratio);
#elif HARMONICS
      if (has_scattered != 0) scattered += irradiance * reflect_point(reflected, towards, depth * extinction_ratio);
#endif
    }
  }
  if (!within_film) return;
  scattered = max(scattered * albedo, vec3(0));  // harmonics cut off at a band may swing below 0
#if ENVIRONMENT
  if (lit) {
#if DEPTH_TREE
    float depth = tree_depth(point);
#else
    float depth = average_depth(vec3(point));
#endif
    vec3 arriving, spread;
    reflect_environment(reflected, (depth + environment_depth) * extinction_ratio, arriving, spread);
    direct += arriving;
    scattered += albedo * spread;
  }
#endif
  vec3 visible = has_airlight != 0 ? transmittance_of(pixels[place].w) : vec3(1);
  for (int c = 0; c < 3; ++c) {
    surface_layer[3 * place + c] = visible[c] * (direct[c] + scattered[c]);
    if (has_scattered != 0) scattered_layer[3 * place + c] = visible[c] * scattered[c];
  }
  if (loops_cut()) surface_layer[3 * place] = -far_away;  // as no light is: the host refuses the picture
}
