// Lists the Gaussians that any ray of a square of tiles may meet, in their order: as methods/fogshop/airlight_pass.cpp. A square is a work
// group; each invocation tests a stretch of the Gaussians. TILES: of a square to a side; SPAN: to a side of those for which
// fogshop/squares.comp has made lists before; 0: it has not.
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

#if SPAN > TILES
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

// Gaussians of a square of TILES x TILES tiles, which is one work group.
void list_gaussians(int first_list) {
  int list = first_list + int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * (2 * gaussian_count + 1);
  int local = int(gl_LocalInvocationIndex);
  ivec2 size = ivec2(LOCAL_SIZE_X, LOCAL_SIZE_Y) * TILES;
  ivec2 first_pixel = ivec2(gl_WorkGroupID.xy) * size + ivec2(0, tile_row * int(LOCAL_SIZE_Y));
  ivec2 pixel = first_pixel + ivec2(gl_LocalInvocationID.xy);
  ivec2 last_pixel = min(first_pixel + size, ivec2(grid_width, grid_height));
  if (local == 0) {
    farthest = spread_bits = start_bits = 0;
    nearest = floatBitsToUint(far_away);
  }
  barrier();
#if TILES > 1
  float far = far_away;
#else
  // Positive floats are in the order of their bits; a ray of length 0 is wanted too.
  if (is_computed(pixel)) {
    atomicMax(farthest, floatBitsToUint(max(ray_length(pixel), 1e-37)));
    atomicMin(nearest, floatBitsToUint(max(ray_length(pixel), 1e-37)));
  }
  barrier();
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

  bool wanted = TILES > 1 || farthest != 0;
  int tested = wanted ? candidates() : 0, each = (tested + group_size - 1) / group_size;
  int begin = local * each, end = min(begin + each, tested), count = 0, found_at = list + 1 + gaussian_count + begin;
  for (int k = begin; k < end; ++k) {
    int i = candidate(k);
    if (touches(cone, gaussians[i], far)) tile_list[found_at + count++] = i;
  }
  int rank = rank_of(local, count), at = list + 1 + rank;
  for (int k = 0; k < count; ++k) {
    int i = tile_list[found_at + k];
    tile_list[at + k] = TILES == 1 && passed_whole(cone, gaussians[i], uintBitsToFloat(nearest)) ? -1 - i : i;
  }
  if (local == group_size - 1) tile_list[list] = wanted ? rank + count : -1;
}
