// The film's layers from optical depths and what lies behind them (eq. 4).
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/film_layers.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_DEPTHS) readonly buffer Depths { vec4 depths[]; };
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen[]; };  // of backdrops [W/m^2/sr]; -1: none
uniform int pixels, has_fog, has_lit, has_seen;

void main() {
  int place = int(gl_GlobalInvocationID.x);
  if (place >= pixels) return;
  vec3 airlight = vec3(0);
  for (int c = 0; has_airlight != 0 && c < 3; ++c) airlight[c] = airlight_layer[3 * place + c];
  vec3 behind = has_lit != 0 ? lit[place].reflected.rgb + lit[place].sum.rgb : vec3(0);
  if (has_seen != 0 && seen[3 * place] >= 0) behind = vec3(seen[3 * place], seen[3 * place + 1], seen[3 * place + 2]);
  put_pixel(place, airlight, has_fog != 0 ? depths[place].rgb : vec3(0), behind);
}
