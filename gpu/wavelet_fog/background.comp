// An environment light behind the fog, added to every pixel whose ray nothing ends.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/environment.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
uniform int has_primitives, first;  // 0: rays are infinite; nothing is in the pixels yet

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= width || at.y >= height) return;
  int place = at.y * width + at.x;
  Lit pixel = Lit(vec4(0), vec4(0), 0, 0);
  if (first == 0) pixel = lit[place];
  if (has_primitives == 0 || primitive_of[place] < 0) {
    vec3 origin, direction;
    camera_ray(vec2(at) + 0.5, origin, direction);
    pixel.sum.rgb += environment_radiance(direction);
  }
  lit[place] = pixel;
}
