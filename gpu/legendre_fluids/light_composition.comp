// The film's layers from columns along camera rays, what these end on, and the light collected.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/opacity.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_COLUMNS) readonly buffer Columns { float columns[]; };
layout(std430, binding = AT_AIRLIGHT) readonly buffer Airlight { float airlight[]; };
layout(std430, binding = AT_TRANSMITTANCE) writeonly buffer Transmittance { float transmittance[]; };
layout(std430, binding = AT_AMBIENT) writeonly buffer Ambient { float ambient_layer[]; };
layout(std430, binding = AT_SURFACE) writeonly buffer Surface { float surface_layer[]; };
layout(std430, binding = AT_MEAN) writeonly buffer Mean { float mean_layer[]; };
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen_there[]; };  // of backdrops [W/m^2/sr]; -1: none
uniform int pixels, has_lit, has_ambient, has_seen;
uniform vec3 ambient;  // [W/m^2/sr]
#if MEDIA > 0
uniform vec3 sigma_t[MEDIA];
#endif

void main() {
  int place = int(gl_GlobalInvocationID.x);
  if (place >= pixels) return;
  vec3 depth = vec3(0), behind = has_lit != 0 ? lit[place].reflected.rgb + lit[place].sum.rgb : vec3(0);
#if MEDIA > 0
  for (int m = 0; m < MEDIA; ++m) depth += sigma_t[m] * columns[place * MEDIA + m];
#endif
  for (int c = 0; c < 3; ++c) {
    if (has_seen != 0 && seen_there[3 * place + c] >= 0) behind[c] = seen_there[3 * place + c];
    float clear = exp(-min(depth[c], 200)), seen = clear * behind[c], fog = ambient[c] * opacity(min(depth[c], 200));
    transmittance[3 * place + c] = clear;
    surface_layer[3 * place + c] = seen;
    mean_layer[3 * place + c] = seen + fog + airlight[3 * place + c];
    if (has_ambient != 0) ambient_layer[3 * place + c] = fog;
  }
}
