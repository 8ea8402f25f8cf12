// The Gaussians that the rays of this work group may meet, read together into shared memory. The group is one tile.
#include "fogshop/tile.glsl"

const int group_size = int(LOCAL_SIZE_X * LOCAL_SIZE_Y);
shared Gaussian near_block[LOCAL_SIZE_X * LOCAL_SIZE_Y];
shared int wish_of_group;

// Every invocation of the group must call it. Returns how many of the block are valid.
int load_near(int first, int count) {
  int local = int(gl_LocalInvocationIndex);
  barrier();
  if (first + local < count) {
    int entry = tile_list[list_of_group() + 1 + first + local];
    near_block[local] = gaussians[entry < 0 ? -1 - entry : entry];
  }
  barrier();
  return min(group_size, count - first);
}

// Does any invocation of the group wish it? Every one must call it, once.
bool any_of_group(bool wish) {
  if (gl_LocalInvocationIndex == 0) wish_of_group = 0;
  barrier();
  if (wish) atomicOr(wish_of_group, 1);
  barrier();
  return wish_of_group != 0;
}
