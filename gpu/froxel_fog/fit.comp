// Where media begin and end in view depth, over the rays through all pixels up to what ends them: reference/froxel_fog/fit.cpp.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "ray_marcher/layer.glsl"

layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
// Bits of floats that are not negative, which are ordered as these: complement of the least, greatest. 0: none.
layout(std430, binding = AT_FITTED) buffer Fitted { uint fitted[2]; };
uniform int has_distances;
const float fitted_depth = 16;  // reference/froxel_fog/fit.h

shared uint of_group[2];

void join(inout vec2 all_, vec2 part) {
  if (part.x < part.y) all_ = vec2(min(all_.x, part.x), max(all_.y, part.y));
}

// Where media begin and end on a ray [m]. A colour channel ends in a constant medium, or where the media end that extinguish it.
vec2 seen_media(vec3 origin, vec3 direction, float t_end) {
  vec2 of_channel[3] = vec2[3](nothing, nothing, nothing), all_ = nothing;
  vec3 dark = vec3(far_away);
  for (int k = 0; k < layer_count; ++k) {
    vec2 whole = clip_region(k, origin, direction, vec2(0, t_end)), varied = nothing;
    if (layers[k].field != field_none && whole.x < whole.y) varied = clip_field(k, origin, direction, whole);
    if (layers[k].constant == 0) whole = nothing;
    for (int c = 0; c < 3; ++c) {
      if (!(layers[k].sigma_t[c] > 0)) continue;
      join(of_channel[c], whole);
      join(of_channel[c], varied);
      if (whole.x < whole.y) dark[c] = min(dark[c], whole.x + fitted_depth / (layers[k].sigma_t[c] * layers[k].constant));
    }
  }
  for (int c = 0; c < 3; ++c) join(all_, vec2(max(of_channel[c].x, 0.0), min(of_channel[c].y, dark[c])));
  return all_;
}

void main() {
  if (gl_LocalInvocationIndex < 2u) of_group[gl_LocalInvocationIndex] = 0u;
  barrier();
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x < width && at.y < height) {
    vec3 origin, direction;
    camera_ray(vec2(at) + 0.5, origin, direction);
    vec2 t = seen_media(origin, direction, has_distances != 0 ? distances[at.y * width + at.x] : far_away);
    if (t.x < t.y) {
      float along = perspective != 0 ? dot(direction, camera_forward) : 1;
      atomicMax(of_group[0], ~floatBitsToUint(t.x * along));
      atomicMax(of_group[1], floatBitsToUint(t.y * along));
    }
  }
  barrier();
  if (gl_LocalInvocationIndex < 2u && of_group[1] != 0u)
    atomicMax(fitted[gl_LocalInvocationIndex], of_group[gl_LocalInvocationIndex]);
}
