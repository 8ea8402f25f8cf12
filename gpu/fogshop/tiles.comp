// Lists the Gaussians that any ray of a tile may meet, in their order: as methods/fogshop/airlight_pass.cpp, and not those behind
// what ends all of its rays. A tile is one work group; each invocation tests a stretch of the Gaussians.
// SPAN: tiles to a side of a square for which Gaussians are listed first; 0: there are no squares. COARSE: lists those of the squares.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/cone.glsl"

layout(std430, binding = AT_TILE_LISTS) buffer TileLists { int tile_list[]; };  // of each tile (fogshop/tile.glsl)
uniform int tile_row;
uniform int squares_at, squares_along;  // where the lists of squares begin, and how many squares lie along the film

const int group_size = int(LOCAL_SIZE_X * LOCAL_SIZE_Y);
#include "fogshop/ranks.glsl"
shared uint farthest, nearest;  // bits of the greatest and the least length of a ray; the greatest 0: no pixel is wanted
shared uint spread_bits, start_bits;

#if SPAN && !COARSE
int square_list() {
  ivec2 square = ivec2(gl_WorkGroupID.xy) / SPAN;
  return squares_at + (square.y * squares_along + square.x) * (2 * gaussian_count + 1);
}
int candidates() { return tile_list[square_list()]; }
int candidate(int i) { return tile_list[square_list() + 1 + i]; }
#else
int candidates() { return gaussian_count; }
int candidate(int i) { return i; }
#endif

void main() {
  int list = (COARSE != 0 ? squares_at : 0) + int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * (2 * gaussian_count + 1);
  int local = int(gl_LocalInvocationIndex);
  ivec2 size = ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y) * (COARSE != 0 ? SPAN : 1);
  ivec2 first_pixel = ivec2(gl_WorkGroupID.xy) * size + ivec2(0, tile_row * int(LOCAL_SIZE_Y));
  ivec2 pixel = first_pixel + ivec2(gl_LocalInvocationID.xy);
  ivec2 last_pixel = min(first_pixel + size, ivec2(grid_width, grid_height));
  if (local == 0) {
    farthest = spread_bits = start_bits = 0;
    nearest = floatBitsToUint(far_away);
  }
  barrier();
#if COARSE
  float far = far_away;
#else
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
#endif
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

  int tested = candidates(), each = (tested + group_size - 1) / group_size;
  int begin = local * each, end = min(begin + each, tested), count = 0, found_at = list + 1 + gaussian_count + begin;
  for (int k = begin; k < end; ++k) {
    int i = candidate(k);
    if (touches(cone, gaussians[i], far)) tile_list[found_at + count++] = i;
  }
  int rank = rank_of(local, count), at = list + 1 + rank;
  for (int k = 0; k < count; ++k) {
    int i = tile_list[found_at + k];
    tile_list[at + k] = COARSE == 0 && passed_whole(cone, gaussians[i], uintBitsToFloat(nearest)) ? -1 - i : i;
  }
  if (local == group_size - 1) tile_list[list] = rank + count;
}
