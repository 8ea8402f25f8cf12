// Lists the Gaussians that any ray of a square of SPAN x SPAN tiles may meet, from which fogshop/tiles.comp chooses.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define TILES SPAN
#include "fogshop/list_gaussians.glsl"

void main() {
  list_gaussians(squares_at);
}
