// The film's layers from optical depths and what lies behind them (eq. 4).
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/film_layers.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_DEPTHS) readonly buffer Depths { vec4 depths[]; };
uniform int pixels, has_fog, has_lit;

void main() {
  int place = int(gl_GlobalInvocationID.x);
  if (place >= pixels) return;
  vec3 airlight = vec3(0);
  for (int c = 0; has_airlight != 0 && c < 3; ++c) airlight[c] = airlight_layer[3 * place + c];
  put_pixel(place, airlight, has_fog != 0 ? depths[place].rgb : vec3(0),
            has_lit != 0 ? lit[place].reflected.rgb + lit[place].sum.rgb : vec3(0));
}
