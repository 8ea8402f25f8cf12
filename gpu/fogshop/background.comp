// The environment behind the medium: Zhou et al. 2007, Eq. 29 with L_p = L_in, added to every pixel whose ray nothing ends.
// One environment light at a time.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "fogshop/fog.glsl"
#include "common/environment.glsl"

layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
layout(std430, binding = AT_PIXELS) readonly buffer Pixels { vec4 pixels[]; };  // airlight, T(v,p)
layout(std430, binding = AT_SURFACE) buffer Surface { float surface_layer[]; };
uniform int has_distances, has_airlight;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  if (has_distances != 0 && distances[place] < far_away) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  vec3 visible = has_airlight != 0 ? transmittance_of(pixels[place].w) : vec3(1);
  vec3 seen = visible * environment_radiance(vec3(direction));
  for (int c = 0; c < 3; ++c) surface_layer[3 * place + c] += seen[c];
}
