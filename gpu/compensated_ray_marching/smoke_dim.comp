// Dims the light that surfaces reflect from one direction by the smoke on its way.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "wavelet_fog/lit.glsl"
#include "compensated_ray_marching/smoke_density.glsl"
#include "compensated_ray_marching/smoke_column.glsl"
uniform dvec3 middle;  // of the smoke [m]
uniform vec3 sigma_t;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  if (lit[place].reflected.rgb == vec3(0)) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  float column = column_from(vec3(origin + lit[place].t * direction - middle));
  if (loops_cut()) column = uintBitsToFloat(0x7fc00000u);  // no number, rather than a wrong one
  lit[place].reflected.rgb *= exp(-min(sigma_t * column, vec3(200)));
}
