// Lists the Gaussians that any ray of a tile may meet, and not those behind what ends all of its rays.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define TILES 1
#include "fogshop/list_gaussians.glsl"

void main() {
  list_gaussians(0);
}
