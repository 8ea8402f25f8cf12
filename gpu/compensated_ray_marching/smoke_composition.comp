// The film's layers from the light of the smoke and what is behind it.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/film_layers.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_COLUMN) readonly buffer Column { float column[]; };  // [m]
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen_there[]; };  // of backdrops [W/m^2/sr]; -1: none
uniform int pixels, has_smoke, has_behind, has_lit, has_seen;
uniform vec3 sigma_t;  // [1/m]

void main() {
  int place = int(gl_GlobalInvocationID.x);
  if (place >= pixels) return;
  vec3 airlight = vec3(0), behind = vec3(0);  // environments of a few bands may be negative
  for (int c = 0; c < 3; ++c) {
    int i = 3 * place + c;
    if (has_smoke != 0) airlight[c] = airlight_layer[i];
    if (has_behind != 0) behind[c] = surface_layer[i];
    if (has_lit != 0) behind[c] += max(lit[place].reflected[c] + lit[place].sum[c], 0.0);
    if (has_seen != 0 && seen_there[i] >= 0) behind[c] = seen_there[i];
  }
  put_pixel(place, airlight, has_smoke != 0 ? sigma_t * column[place] : vec3(0), behind);
}
