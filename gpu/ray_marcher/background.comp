// An environment light behind the media, added to every pixel whose ray nothing ends.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/environment.glsl"
#include "ray_marcher/pixel.glsl"

layout(std430, binding = AT_PRIMITIVES) readonly buffer Primitives { int primitive_of[]; };  // by pixel; -1: none
layout(std430, binding = AT_SURFACE) buffer Surface { float surface_layer[]; };
uniform int rows, first_row;              // of the band
uniform int has_primitives, has_surface;  // 0: rays are infinite; nothing is in the layer yet

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= width || at.y >= rows) return;
  int place = at.y * width + at.x, film_place = place + first_row * width;
  vec3 seen = vec3(0), through = vec3(1);
  if (has_primitives == 0 || primitive_of[film_place] < 0) {
    vec3 origin, direction;
    camera_ray(vec2(at.x, at.y + first_row) + 0.5, origin, direction);
#if LAYERS
    through = pixels[place].transmittance;
#endif
    seen = through * environment_radiance(direction);
  }
  for (int c = 0; c < 3; ++c)
    surface_layer[3 * film_place + c] = seen[c] + (has_surface != 0 ? surface_layer[3 * film_place + c] : 0);
}
