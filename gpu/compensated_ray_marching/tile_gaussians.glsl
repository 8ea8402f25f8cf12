// Gaussians that a tile of camera rays may meet between two distances, one per lane: the tile's rays lie in a cone, or, if parallel, in
// a cylinder. The result is one bit per Gaussian, so that the order of sums does not depend on the order of lanes.
const int tile_lanes = LOCAL_SIZE_X * LOCAL_SIZE_Y, tile_words = (tile_lanes + 31) / 32;
shared uint tile_met[3 * tile_words];                  // of three turns: one is written, one is read, one is cleared
shared uint tile_nearest, tile_farthest, tile_spread;  // bits of floats that are not below 0: [m], sine of the cone, or radius [m]
vec3 tile_origin, tile_axis;

// `active_`: whether the invocation has a ray, and wants what lies between the distances [m]. False: no invocation of the tile does.
bool begin_tile(bool active_, vec3 origin, vec3 direction, vec2 distances) {
  int local = int(gl_LocalInvocationIndex);
  if (local == 0) {
    tile_nearest = floatBitsToUint(1e37);
    tile_farthest = tile_spread = 0u;
  }
  if (local < 3 * tile_words) tile_met[local] = 0u;
  barrier();
  camera_ray((vec2(gl_WorkGroupID.xy) + 0.5) * vec2(LOCAL_SIZE_X, LOCAL_SIZE_Y), tile_origin, tile_axis);
  if (active_) {
    float away = perspective == 0                   ? length(origin - tile_origin)
                 : dot(direction, tile_axis) > 0.1 ? length(cross(direction, tile_axis))
                                                   : 2;  // small films of wide cameras: no cone
    atomicMax(tile_spread, floatBitsToUint(away));
    atomicMin(tile_nearest, floatBitsToUint(distances.x));
    atomicMax(tile_farthest, floatBitsToUint(distances.y));
  }
  barrier();
  return tile_farthest != 0u;
}

bool tile_touches(vec3 center, float reach) {
  vec3 offset = center - tile_origin;
  float along = dot(offset, tile_axis), aside = length(offset - along * tile_axis), spread = uintBitsToFloat(tile_spread);
  float far = perspective != 0 ? length(offset) : along;
  reach += 1e-4 * reach + 1e-5 * length(offset);  // more than rounding
  if (far - reach > uintBitsToFloat(tile_farthest) || far + reach < uintBitsToFloat(tile_nearest)) return false;
  if (perspective == 0) return aside <= reach + spread;
  return spread > 1 || aside * sqrt(max(1 - spread * spread, 0.0)) - along * spread <= reach;
}

// All invocations of the tile, the Gaussians of a turn: tile_word(turn, w) has the bits of numbers turn * tile_lanes + 32 w on.
void look_at(int turn) {
  int local = int(gl_LocalInvocationIndex), i = turn * tile_lanes + local, now = turn % 3 * tile_words;
  if (i < gaussian_count && tile_touches(gaussians[i].center, gaussians[i].width * sqrt(farthest)))
    atomicOr(tile_met[now + local / 32], 1u << (local % 32));
  barrier();
  if (local < tile_words) tile_met[(turn + 2) % 3 * tile_words + local] = 0u;
}
uint tile_word(int turn, int w) { return tile_met[turn % 3 * tile_words + w]; }
