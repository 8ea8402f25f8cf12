// The layers of the film: L = L_a + e^-T L_p, Eq. 29.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "fogshop/fog.glsl"

layout(std430, binding = AT_PIXELS) readonly buffer Pixels { vec4 pixels[]; };                // airlight, depth
layout(std430, binding = AT_SURFACE) buffer Surface { float surface_layer[]; };                 // through the medium
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen[]; };  // of backdrops [W/m^2/sr]; -1: none
layout(std430, binding = AT_AIRLIGHT_LAYER) writeonly buffer Airlight { float airlight_layer[]; };
layout(std430, binding = AT_TRANSMITTANCE_LAYER) writeonly buffer Transmittance { float transmittance_layer[]; };
layout(std430, binding = AT_MEAN_LAYER) writeonly buffer Mean { float mean_layer[]; };
uniform int has_airlight, has_surface, has_seen, pixel_count;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= pixel_count) return;
  vec3 airlight = has_airlight != 0 ? pixels[i].rgb : vec3(0);
  vec3 visible = has_airlight != 0 ? transmittance_of(pixels[i].w) : vec3(1);
  bool shown = has_seen != 0 && seen[3 * i] >= 0;
  for (int c = 0; c < 3; ++c) {
    if (shown) surface_layer[3 * i + c] = visible[c] * seen[3 * i + c];
    airlight_layer[3 * i + c] = airlight[c];
    transmittance_layer[3 * i + c] = visible[c];
    mean_layer[3 * i + c] = airlight[c] + (has_surface != 0 ? surface_layer[3 * i + c] : 0);
  }
}
