// An environment light behind the smoke, added to what is there.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/environment.glsl"
layout(std430, binding = AT_SURFACE) buffer Surface { float surface[]; };
uniform int first;  // nothing is there yet

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= width || at.y >= height) return;
  vec3 origin, direction;
  camera_ray(vec2(at) + 0.5, origin, direction);
  vec3 sum = environment_radiance(direction);
  int place = 3 * (at.y * width + at.x);
  for (int c = 0; c < 3; ++c) surface[place + c] = sum[c] + (first != 0 ? 0 : surface[place + c]);
}
