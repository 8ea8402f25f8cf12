// The film's layers from what all lights left, seen through the media; the ambient fog where asked for.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "shadow_planes/media.glsl"

layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
#include "shadow_planes/pixels.glsl"
layout(std430, binding = AT_AIRLIGHT_LAYER) writeonly buffer AirlightLayer { float airlight_layer[]; };
layout(std430, binding = AT_TRANSMITTANCE_LAYER) writeonly buffer TransmittanceLayer { float transmittance_layer[]; };
layout(std430, binding = AT_SURFACE_LAYER) writeonly buffer SurfaceLayer { float surface_layer[]; };
layout(std430, binding = AT_AMBIENT_LAYER) writeonly buffer AmbientLayer { float ambient_layer[]; };
layout(std430, binding = AT_MEAN_LAYER) writeonly buffer MeanLayer { float mean_layer[]; };
uniform int has_distances, has_ambient, lights;
uniform vec3 ambient;  // [W/m^2/sr]

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  dvec3 origin, direction;
  LitPixel lit = LitPixel(vec4(0), vec4(0));
  if (lights != 0) lit = lit_pixels[place];
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  double end = has_distances != 0 ? double(distances[place]) : 1e37LF;
  vec3 visible = exp(-min(depth_along(origin, direction, end), 200));
  vec3 fog = ambient * (1 - visible), on_surface = visible * lit.reflected.rgb;
  for (int c = 0; c < 3; ++c) {
    airlight_layer[3 * place + c] = lit.airlight[c];
    transmittance_layer[3 * place + c] = visible[c];
    surface_layer[3 * place + c] = on_surface[c];
    if (has_ambient != 0) ambient_layer[3 * place + c] = fog[c];
    mean_layer[3 * place + c] = lit.airlight[c] + on_surface[c] + fog[c];
  }
}
