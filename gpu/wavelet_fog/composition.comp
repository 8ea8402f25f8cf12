// The film's layers from optical depths and what lies behind them (eq. 4).
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/opacity.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_DEPTHS) readonly buffer Depths { vec4 depths[]; };
layout(std430, binding = AT_TRANSMITTANCE_LAYER) writeonly buffer TransmittanceLayer { float transmittance_layer[]; };
layout(std430, binding = AT_AMBIENT_LAYER) writeonly buffer AmbientLayer { float ambient_layer[]; };
layout(std430, binding = AT_SURFACE_LAYER) writeonly buffer SurfaceLayer { float surface_layer[]; };
layout(std430, binding = AT_MEAN_LAYER) writeonly buffer MeanLayer { float mean_layer[]; };
layout(std430, binding = AT_AIRLIGHT_LAYER) readonly buffer AirlightLayer { float airlight_layer[]; };
uniform int pixels, has_fog, has_lit, has_ambient, has_airlight;
uniform vec3 ambient;  // [W/m^2/sr]

void main() {
  int place = int(gl_GlobalInvocationID.x);
  if (place >= pixels) return;
  vec3 depth = has_fog != 0 ? depths[place].rgb : vec3(0);
  vec3 behind = has_lit != 0 ? lit[place].reflected.rgb + lit[place].sum.rgb : vec3(0);
  for (int c = 0; c < 3; ++c) {
    float clear = exp(-min(depth[c], 200)), surface = clear * behind[c], fog = ambient[c] * opacity(depth[c]);
    transmittance_layer[3 * place + c] = clear;
    surface_layer[3 * place + c] = surface;
    mean_layer[3 * place + c] = surface + fog + (has_airlight != 0 ? airlight_layer[3 * place + c] : 0);
    if (has_ambient != 0) ambient_layer[3 * place + c] = fog;
  }
}
