// The layers of the film from what pixels know, and sums of their counters for those who ask.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "ray_marcher/pixel.glsl"

layout(std430, binding = AT_AIRLIGHT_LAYER) writeonly buffer Airlight { float airlight_layer[]; };
layout(std430, binding = AT_TRANSMITTANCE_LAYER) writeonly buffer Transmittance { float transmittance_layer[]; };
layout(std430, binding = AT_MEAN_LAYER) writeonly buffer Mean { float mean_layer[]; };
layout(std430, binding = AT_SURFACE) buffer Surface { float surface_layer[]; };
// Low and high words: steps, shadow rays, shadow steps, occlusion rays.
layout(std430, binding = AT_TOTALS) buffer Totals { uint totals[8]; };
layout(std430, binding = AT_SEEN) readonly buffer Seen { float seen[]; };  // of backdrops; -1: none
uniform int has_seen;
uniform int pixel_count, first_pixel;  // of the band; of it in the film
uniform int has_media, has_surface, counts;

shared uint partial[4][LOCAL_SIZE_X];

void main() {
  int place = int(gl_GlobalInvocationID.x), film_place = first_pixel + place;
  bool inside = place < pixel_count;
  Pixel pixel = Pixel(vec3(0), 0u, vec3(1), 0u, 0u, 0u, 0, 0, 0, 0, 0, 0);
  if (inside) {
    if (has_media != 0)
      pixel = pixels[place];
    else if (counts != 0)  // surfaces in vacuum
      pixel.shadow_rays = pixels[place].shadow_rays, pixel.occlusion_rays = pixels[place].occlusion_rays;
    for (int c = 0; c < 3; ++c) {
      int value = 3 * film_place + c;
      float behind = has_surface != 0 ? surface_layer[value] : 0;
      bool pictured = has_seen != 0 && seen[value] >= 0;
      if (pictured) behind = pixel.transmittance[c] * seen[value];
      airlight_layer[value] = pixel.airlight[c];
      transmittance_layer[value] = pixel.transmittance[c];
      mean_layer[value] = pixel.airlight[c] + behind;
      if (has_surface == 0 || pictured) surface_layer[value] = behind;
    }
  }
  if (counts == 0) return;
  uint own[4] = uint[4](pixel.steps, pixel.shadow_rays, pixel.shadow_steps, pixel.occlusion_rays);
  int me = int(gl_LocalInvocationID.x);
  for (int i = 0; i < 4; ++i) partial[i][me] = inside ? own[i] : 0u;
  barrier();
  if (me >= 4) return;
  uint low = 0u, high = 0u;
  for (int i = 0; i < LOCAL_SIZE_X; ++i) {
    low += partial[me][i];
    if (low < partial[me][i]) ++high;
  }
  if (atomicAdd(totals[2 * me], low) > 0xffffffffu - low) ++high;
  if (high > 0u) atomicAdd(totals[2 * me + 1], high);
}
