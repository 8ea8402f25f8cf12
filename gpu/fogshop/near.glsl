// The Gaussians that the rays of this work group may meet, read together into shared memory. The group is one tile.
layout(std430, binding = 1) readonly buffer TileCounts { int tile_count[]; };
layout(std430, binding = 2) readonly buffer TileLists { int tile_list[]; };
uniform int tile_row;  // of the first tile of this dispatch: lists hold a strip of the image

const int group_size = int(LOCAL_SIZE_X * LOCAL_SIZE_Y);
shared Gaussian near_block[LOCAL_SIZE_X * LOCAL_SIZE_Y];

// -1: no pixel of the tile is wanted.
int near_count() { return tile_count[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x]; }

// Every invocation of the group must call it. Returns how many of the block are valid.
int load_near(int first, int count) {
  int local = int(gl_LocalInvocationIndex);
  int tile = int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x);
  barrier();
  if (first + local < count) near_block[local] = gaussians[tile_list[tile * gaussian_count + first + local]];
  barrier();
  return min(group_size, count - first);
}
