// An environment light behind the smoke, added to what is there, where nothing ends the ray.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/environment.glsl"
layout(std430, binding = AT_SURFACE_LAYER) buffer Surface { float surface[]; };
layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
uniform int first, has_primitives;  // nothing is there yet; rays may end

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= width || at.y >= height) return;
  vec3 origin, direction;
  camera_ray(vec2(at) + 0.5, origin, direction);
  vec3 sum = vec3(0);
  if (has_primitives == 0 || primitive_of[at.y * width + at.x] < 0) sum = environment_radiance(direction);
  int place = 3 * (at.y * width + at.x);
  for (int c = 0; c < 3; ++c) surface[place + c] = sum[c] + (first != 0 ? 0 : surface[place + c]);
}
