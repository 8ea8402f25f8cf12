// Integrals of densities from a point towards a light: reference/ray_marcher/columns.cpp and its kernels.
// DEPTHS: 0 media dim no light on its way, 1 columns by steps, 2 maps of the lights, 3 columns without steps.
uint shadow_step_count = 0;  // density evaluations of this invocation

#if DEPTHS > 0
// Column of layer k's constant along a ray that is clipped to the region [m].
float constant_column(int k, vec2 t) {
  return layers[k].constant > 0 && t.x < t.y ? min(layers[k].constant * min(t.y - t.x, endless), endless) : 0;
}
#endif

#if DEPTHS == 2
#include "light_map/look_up.glsl"
vec3 depth_towards(int l, vec3 x, vec3 direction, float distance_) {
  vec3 depth = mapped_depth(l, x);
  for (int k = 0; k < layer_count; ++k)
    if (layers[k].constant > 0)
      depth += layers[k].sigma_t * constant_column(k, clip_region(k, x, direction, vec2(0, distance_)));
  return depth;
}
#elif DEPTHS == 0
vec3 depth_towards(int l, vec3 x, vec3 direction, float distance_) { return vec3(0); }
#else
#if GAUSSIANS
#include "ray_marcher/gaussian_profile.glsl"
#endif
#if DEPTHS == 1
#include "ray_marcher/marched_columns.glsl"
#else
#include "ray_marcher/exact_columns.glsl"
#endif

// Column of layer k from x over a distance in a unit direction [m].
float column_of(int k, vec3 x, vec3 direction, float distance_) {
  vec2 t = clip_region(k, x, direction, vec2(0, distance_));
  if (!(t.x < t.y)) return 0;
  float column = constant_column(k, t);
  if (layers[k].field == field_none) return column;
  t = clip_field(k, x, direction, t);
  if (!(t.x < t.y)) return column;
  return column + varied_column(k, to_local(layers[k].field_frame, x), rotate_to_local(layers[k].field_frame, direction), t);
}

// Optical depth of all media from x to light l, which lies in a unit direction and at a distance [m].
vec3 depth_towards(int l, vec3 x, vec3 direction, float distance_) {
  vec3 depth = vec3(0);
  for (int k = 0; k < layer_count; ++k) depth += layers[k].sigma_t * column_of(k, x, direction, distance_);
  return depth;
}
#endif
