// Lists the Gaussians that any ray of a tile may meet, in their order: as methods/fogshop/airlight_pass.cpp, and not those behind
// what ends all of its rays. A tile is one work group; each invocation tests a stretch of the Gaussians.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/cone.glsl"

layout(std430, binding = AT_TILE_LISTS) buffer TileLists { int tile_list[]; };  // of each tile (fogshop/tile.glsl)
uniform int tile_row;

const int group_size = int(LOCAL_SIZE_X * LOCAL_SIZE_Y);
#include "fogshop/ranks.glsl"
shared uint farthest, nearest;  // bits of the greatest and the least length of a ray; the greatest 0: no pixel is wanted
shared uint spread_bits, start_bits;

void main() {
  int list = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * (2 * gaussian_count + 1);
  int local = int(gl_LocalInvocationIndex);
  ivec2 first_pixel = ivec2(gl_WorkGroupID.xy) * ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y) + ivec2(0, tile_row * int(LOCAL_SIZE_Y));
  ivec2 pixel = first_pixel + ivec2(gl_LocalInvocationID.xy);
  ivec2 last_pixel = min(first_pixel + ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y), ivec2(grid_width, grid_height));
  if (local == 0) {
    farthest = spread_bits = start_bits = 0;
    nearest = floatBitsToUint(far_away);
  }
  barrier();
  // Positive floats are in the order of their bits; a ray of length 0 is wanted too.
  if (is_computed(pixel)) {
    atomicMax(farthest, floatBitsToUint(max(ray_length(pixel), 1e-37)));
    atomicMin(nearest, floatBitsToUint(max(ray_length(pixel), 1e-37)));
  }
  barrier();
  if (farthest == 0) {
    if (local == 0) tile_list[list] = -1;
    return;
  }
  float far = uintBitsToFloat(farthest) * 1.0001;
  vec2 first = float(film_step) * vec2(first_pixel), last = float(film_step) * vec2(last_pixel);
  vec3 origin, axis;
  camera_ray(0.5 * (first + last), origin, axis);
  // How far other rays start from the middle one, and spread per metre: the corners' most.
  vec3 o, d;
  camera_ray(vec2((local & 1) != 0 ? last.x : first.x, (local & 2) != 0 ? last.y : first.y), o, d);
  if (local < 4) {
    atomicMax(start_bits, floatBitsToUint(length(o - origin)));
    atomicMax(spread_bits, floatBitsToUint(length(d - axis)));
  }
  barrier();
  Cone cone = cone_of(origin, axis, uintBitsToFloat(start_bits), uintBitsToFloat(spread_bits));

  int each = (gaussian_count + group_size - 1) / group_size;
  int begin = local * each, end = min(begin + each, gaussian_count), count = 0, found_at = list + 1 + gaussian_count + begin;
  for (int i = begin; i < end; ++i)
    if (touches(cone, gaussians[i], far)) tile_list[found_at + count++] = i;
  int rank = rank_of(local, count), at = list + 1 + rank;
  for (int k = 0; k < count; ++k) {
    int i = tile_list[found_at + k];
    tile_list[at + k] = passed_whole(cone, gaussians[i], uintBitsToFloat(nearest)) ? -1 - i : i;
  }
  if (local == group_size - 1) tile_list[list] = rank + count;
}
