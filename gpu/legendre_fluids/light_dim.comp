// Dims the light that surfaces reflect of a lamp by the media on its way.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "wavelet_fog/lit.glsl"
#include "legendre_fluids/light_media.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  if (lit[place].reflected.rgb == vec3(0)) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  dvec3 point = origin + lit[place].t * direction;
  vec3 depth = vec3(0);
  for (int m = 0; m < MEDIA; ++m) {
    dvec3 local = (point - box_middle[m]) * per_half[m];
    vec3 rate = vec3(to_light * per_half[m]);
    Way way = way_from(local, rate);
    depth += sigma_t[m] * column_from(m, vec3(local), rate, way);
  }
  lit[place].reflected.rgb *= exp(-min(depth, 200));
}
