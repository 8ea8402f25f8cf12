// The film's layers from columns along camera rays, what these end on, and the light collected.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/film_layers.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_COLUMNS) readonly buffer Columns { float columns[]; };
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen_there[]; };  // of backdrops [W/m^2/sr]; -1: none
uniform int pixels, has_lit, has_seen;
#if MEDIA > 0
uniform vec3 sigma_t[MEDIA];
#endif

void main() {
  int place = int(gl_GlobalInvocationID.x);
  if (place >= pixels) return;
  vec3 airlight, depth = vec3(0), behind = has_lit != 0 ? lit[place].reflected.rgb + lit[place].sum.rgb : vec3(0);
#if MEDIA > 0
  for (int m = 0; m < MEDIA; ++m) depth += sigma_t[m] * columns[place * MEDIA + m];
#endif
  for (int c = 0; c < 3; ++c) {
    airlight[c] = airlight_layer[3 * place + c];
    if (has_seen != 0 && seen_there[3 * place + c] >= 0) behind[c] = seen_there[3 * place + c];
  }
  put_pixel(place, airlight, depth, behind);
}
