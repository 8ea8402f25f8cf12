// The film's layers from what all lights left, seen through the media; the ambient fog where asked for.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "common/film_layers.glsl"
#include "shadow_planes/media.glsl"

layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
#include "shadow_planes/pixels.glsl"
uniform int has_distances, lights;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  dvec3 origin, direction;
  LitPixel lit = LitPixel(vec4(0), vec4(0));
  if (lights != 0) lit = lit_pixels[place];
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  double end = has_distances != 0 ? double(distances[place]) : 1e37LF;
  put_pixel(place, lit.airlight.rgb, depth_along(origin, direction, end), lit.reflected.rgb);
}
