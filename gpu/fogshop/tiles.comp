// Lists the Gaussians that any ray of a tile may meet, one tile per invocation: as methods/fogshop/airlight_pass.cpp.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/camera.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"

layout(std430, binding = 1) writeonly buffer TileCounts { int tile_count[]; };
layout(std430, binding = 2) writeonly buffer TileLists { int tile_list[]; };
uniform int tile_row, tile_rows, tile_columns;

void main() {
  int tile = int(gl_GlobalInvocationID.x);
  if (tile >= tile_rows * tile_columns) return;
  ivec2 first_pixel = TILE * ivec2(tile % tile_columns, tile_row + tile / tile_columns);
  ivec2 last_pixel = min(first_pixel + TILE, ivec2(grid_width, grid_height));
  if (only_edges != 0) {
    bool wanted = false;
    for (int y = first_pixel.y; y < last_pixel.y; ++y)
      for (int x = first_pixel.x; x < last_pixel.x; ++x) wanted = wanted || is_computed(ivec2(x, y));
    if (!wanted) {
      tile_count[tile] = -1;
      return;
    }
  }
  vec2 first = float(film_step) * vec2(first_pixel), last = float(film_step) * vec2(last_pixel);
  vec3 origin, axis;
  camera_ray(0.5 * (first + last), origin, axis);
  // How far other rays start from the middle one, and spread per metre; rounding counted against it.
  float start = 0, spread = 0;
  for (int corner = 0; corner < 4; ++corner) {
    vec3 o, d;
    camera_ray(vec2((corner & 1) != 0 ? last.x : first.x, (corner & 2) != 0 ? last.y : first.y), o, d);
    start = max(start, length(o - origin));
    spread = max(spread, length(d - axis));
  }
  spread = spread * 1.0001 + 1e-6;
  float cosine = sqrt(max(0, 1 - spread * spread));
  int count = 0;
  for (int i = 0; i < gaussian_count; ++i) {
    vec3 q = gaussians[i].center - origin;
    float m = dot(q, axis), p = length(q - m * axis);
    float least = m + p * spread / cosine > 0 ? p * cosine - spread * m : length(q);
    if (spread >= 1 || least <= sqrt(gaussians[i].radius_squared) * 1.0001 + start)
      tile_list[tile * gaussian_count + count++] = i;
  }
  tile_count[tile] = count;
}
