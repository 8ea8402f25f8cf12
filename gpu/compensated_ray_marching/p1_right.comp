// The right side of diffusion on a grid, of every light of a solve, and the parts of its square.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/p1.glsl"
#include "compensated_ray_marching/p1_source.glsl"
#include "compensated_ray_marching/p1_sums.glsl"
#include "compensated_ray_marching/diffusion_vectors.glsl"

void main() {
  int light = int(gl_WorkGroupID.z), right = vector_at(light, RIGHT);
  double squares = 0;
  for (int at = int(gl_GlobalInvocationID.x); at < cell_count(); at += groups * LOCAL_SIZE_X) {
    Cell cell = cell_of(at);
    double sum = extinction_of(at) * mean_source(light, at);
    for (int axis = 0; axis < 3; ++axis) {
      if (!ends_on(axis)) continue;
      for (int side = -1; side < 2; side += 2)
        sum -= double(side) * pushed(light, cell, axis, side) / (resistance(cell, axis, side) * edge_on(axis));
    }
    vectors[right + at] = sum;
    squares += sum * sum;
  }
  keep(SUM_OF_RIGHT, squares);
}
