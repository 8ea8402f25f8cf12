// Each pixel looks the volume up where its ray ends, or in the last slice: Volume::look_up of reference/froxel_fog.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "ray_marcher/pixel.glsl"
#include "froxel_fog/grid.glsl"
#include "froxel_fog/slices.glsl"

layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
layout(std430, binding = AT_AIRLIGHT) readonly buffer Airlight { vec4 airlight_up_to[]; };
layout(std430, binding = AT_TRANSMITTANCE) readonly buffer Transmittance { vec4 transmittance_up_to[]; };
uniform int first_row, band_rows, has_distances;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= width || at.y >= band_rows) return;
  int place = at.y * width + at.x;
  at.y += first_row;
  vec3 airlight = vec3(0), transmittance = vec3(0);
  if (slice_values[2] == 0) {
    transmittance = vec3(1);
  } else {
    vec3 origin, direction;
    vec2 film = vec2(at) + 0.5;
    camera_ray(film, origin, direction);
    float t = has_distances != 0 ? distances[at.y * width + at.x] : 1e37;
    float u = encode_depth(t * depth_per_metre(direction), vec2(slice_values[0], slice_values[1]));
    // Ends of slices: the first is the range's beginning, where nothing is swallowed yet.
    Between across = between(film.x / cell_width - 0.5, columns), down = between(film.y / cell_height - 0.5, rows),
            deep = between(u * float(slices), slices + 1);
    for (int corner = 0; corner < 8; ++corner) {
      ivec3 up = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      vec3 shares = vec3(across.share, down.share, deep.share), share = mix(1 - shares, shares, equal(up, ivec3(1)));
      float w = share.x * share.y * share.z;
      if (w == 0) continue;  // there may be no such neighbour
      int before = deep.low + up.z - 1, froxel = froxel_at(across.low + up.x, down.low + up.y, before);
      if (before >= 0) airlight += w * airlight_up_to[froxel].rgb;
      transmittance += w * (before >= 0 ? transmittance_up_to[froxel].rgb : vec3(1));
    }
  }
  pixels[place] = Pixel(airlight, 0u, transmittance, 0u, 0u, 0u, 0, 0, 0, 0, 0, 0);
}
