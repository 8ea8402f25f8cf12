// Tiles whose pixels take several dispatches (gpu/ray_marcher/rounds.h): each round finds the groups of the next.
//
// Four times the groups of a dispatch, of which round r uses r mod 4; then of each tile the last round that it was left to; then
// two lists of tiles, for odd and for even rounds.
layout(std430, binding = AT_ROUNDS) buffer Rounds { int rounds[]; };
uniform int round_, first_tile, tile_count;
uniform int budget;  // iterations of loops in a round, roughly

int list_of(int round) { return 12 + (1 + (round & 1)) * tile_count; }

int tile_of_group() {
  int group = int(gl_WorkGroupID.x);
  // Rounds that come later find no groups, unless this one leaves some.
  if (group == 0 && gl_LocalInvocationIndex == 0u)
    for (int later = 2; later <= 4; ++later) rounds[3 * ((round_ + later) & 3)] = 0;
  return round_ == 0 ? first_tile + group : rounds[list_of(round_) + group];
}
void leave_to_next_round(int tile) {
  int next = round_ + 1;
  if (atomicExchange(rounds[12 + tile], next) == next) return;
  int groups = 3 * (next & 3);
  rounds[list_of(next) + atomicAdd(rounds[groups], 1)] = tile;
  rounds[groups + 1] = rounds[groups + 2] = 1;
}
