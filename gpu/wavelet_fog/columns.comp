// Optical depths through one medium, a ray per invocation: LIGHT_RAYS 0 camera rays, 1 rays from what they end on to a light.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "wavelet_fog/column.glsl"
#if VARIANT == VARIANT_POLAR
#include "wavelet_fog/polar.glsl"
#endif
#if LIGHT_RAYS
#include "wavelet_fog/lit.glsl"
#include "wavelet_fog/lamp.glsl"
#else
#include "common/loops_cut.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
layout(std430, binding = AT_DEPTHS) buffer Depths { vec4 depths[]; };  // w: integral of this medium in the parts so far
// Low and high words: cells, coefficients; loops cut; 7, 8: lookups.
layout(std430, binding = AT_COUNTERS) buffer Counters { uint counters[]; };
uniform int has_distances, first, counts;

shared uint cells_of_group, lookups_of_group, wavelet_cells_of_group;
void add_to_counter(int low, uint amount) {
  if (atomicAdd(counters[low], amount) > 0xffffffffu - amount) atomicAdd(counters[low + 1], 1u);
}
#endif

// Details may leave less than nothing; a channel without extinction stays clear over any length.
vec3 depth_of(float integral) { return vec3(fog.sigma_t[0], fog.sigma_t[1], fog.sigma_t[2]) * max(integral, 0); }

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  bool inside = at.x < view_width && at.y < view_height;
  int place = at.y * view_width + at.x;
  dvec3 origin, direction;
  view_ray(dvec2(at) + 0.5LF, origin, direction);
#if LIGHT_RAYS
  if (!inside || lit[place].reflected.rgb == vec3(0)) return;
  dvec3 point = origin + lit[place].t * direction, to_light;
  double distance_;
  lamp_from(point, to_light, distance_);
  float sum = (part > 0 ? lit[place].reflected.w : 0) + column(point, to_light, distance_);
  lit[place].reflected = part + 1 < parts ? vec4(lit[place].reflected.rgb, sum) : vec4(lit[place].reflected.rgb * exp(-depth_of(sum)), 0);
#else
  uint lookups = 0u;
  if (gl_LocalInvocationIndex == 0u) cells_of_group = lookups_of_group = wavelet_cells_of_group = 0u;
  if (inside) {
    double end = has_distances != 0 ? double(distances[place]) : 1e37LF;
#if VARIANT == VARIANT_POLAR
    float sum = column_of_table(origin, direction, end, lookups);
#else
    float sum = column(origin, direction, end);
#endif
    vec4 before = first != 0 && part == 0 ? vec4(0) : depths[place];
    sum += before.w;
    depths[place] = part + 1 < parts ? vec4(before.rgb, sum) : vec4(before.rgb + depth_of(sum), 0);
  }
  if (counts == 0) return;
  barrier();
  atomicAdd(cells_of_group, cells_read);
  atomicAdd(lookups_of_group, lookups);
#if VARIANT == VARIANT_PRE
  atomicAdd(wavelet_cells_of_group, wavelet_cells);
#endif
  if (inside && loops_cut()) counters[4] = 1u;
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  add_to_counter(0, cells_of_group + wavelet_cells_of_group);
  add_to_counter(2, cells_of_group * uint((DEGREE + 1) * (DEGREE + 1)) + wavelet_cells_of_group * uint(WAVELET_COEFFICIENTS));
  add_to_counter(7, lookups_of_group);
#endif
}
