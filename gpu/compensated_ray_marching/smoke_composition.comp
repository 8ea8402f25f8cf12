// The film's layers from the light of the smoke and what is behind it.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/opacity.glsl"
#include "wavelet_fog/lit.glsl"
layout(std430, binding = AT_AIRLIGHT) buffer Airlight { float airlight[]; };
layout(std430, binding = AT_COLUMN) readonly buffer Column { float column[]; };  // [m]
layout(std430, binding = AT_TRANSMITTANCE) writeonly buffer Transmittance { float transmittance[]; };
layout(std430, binding = AT_SURFACE) buffer Surface { float surface[]; };
layout(std430, binding = AT_AMBIENT) writeonly buffer Ambient { float ambient_layer[]; };
layout(std430, binding = AT_MEAN) writeonly buffer Mean { float mean[]; };
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen_there[]; };  // of backdrops [W/m^2/sr]; -1: none
uniform int values, has_smoke, has_behind, has_ambient, has_lit, has_seen;
uniform vec3 sigma_t;  // [1/m]
uniform vec3 ambient;  // [W/m^2/sr]

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= values) return;
  float depth = has_smoke != 0 ? min(sigma_t[i % 3] * column[i / 3], 200.0) : 0, clear = exp(-depth);
  if (has_smoke == 0) airlight[i] = 0;
  float there = has_behind != 0 ? surface[i] : 0, fog = ambient[i % 3] * opacity(depth);
  if (has_lit != 0) there += max(lit[i / 3].reflected[i % 3] + lit[i / 3].sum[i % 3], 0.0);
  if (has_seen != 0 && seen_there[i] >= 0) there = seen_there[i];
  float behind = clear * there;  // environments of a few bands may be negative
  transmittance[i] = clear;
  surface[i] = behind;
  mean[i] = airlight[i] + behind + fog;
  if (has_ambient != 0) ambient_layer[i] = fog;
}
