// A pixel's parts in the film's layers, as scene/picture.h; gpu/film_layers.h binds them.
#include "common/opacity.glsl"
layout(std430, binding = AT_MEAN_LAYER) writeonly buffer MeanLayer { float mean_layer[]; };
layout(std430, binding = AT_TRANSMITTANCE_LAYER) writeonly buffer TransmittanceLayer { float transmittance_layer[]; };
layout(std430, binding = AT_SURFACE_LAYER) buffer SurfaceLayer { float surface_layer[]; };
layout(std430, binding = AT_AIRLIGHT_LAYER) buffer AirlightLayer { float airlight_layer[]; };
layout(std430, binding = AT_AMBIENT_LAYER) writeonly buffer AmbientLayer { float ambient_layer[]; };
uniform int has_airlight, has_ambient;  // layers of their own
uniform vec3 ambient;                   // [W/m^2/sr]

// Light from the air and from what ends the ray, which the optical depth up to there dims; the ambient term of the fog.
void put_pixel(int place, vec3 airlight, vec3 depth, vec3 behind) {
  for (int c = 0; c < 3; ++c) {
    int at = 3 * place + c;
    float d = min(depth[c], 200), clear = exp(-d), surface = clear * behind[c], fog = ambient[c] * opacity(d);
    transmittance_layer[at] = clear;
    surface_layer[at] = surface;
    mean_layer[at] = airlight[c] + surface + fog;
    if (has_airlight != 0) airlight_layer[at] = airlight[c];
    if (has_ambient != 0) ambient_layer[at] = fog;
  }
}
