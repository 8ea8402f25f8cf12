// Conjugate gradients of diffusion on a grid. Cells of colour 0 are eliminated: their residual is 0, so that the residual of the others is
// that of the whole system. An iteration is four dispatches, a system a layer of work groups.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/p1.glsl"
#include "compensated_ray_marching/p1_matrix.glsl"
#include "compensated_ray_marching/p1_sums.glsl"
#include "compensated_ray_marching/diffusion_vectors.glsl"
uniform int stage, iteration, most_iterations;  // iteration: from 1
uniform double tolerance;

double inverse_of(int cell) { return matrix[INVERSE * cell_count() + cell]; }
double diagonal_of(int cell) { return matrix[DIAGONAL * cell_count() + cell]; }
// What a row takes of its neighbours.
double around(int cell, int vector) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = -1; side < 2; side += 2) {
      double share = share_of(cell, axis, side);
      if (share != 0) sum += share * vectors[vector + cell + side * stride_of(axis)];
    }
  return sum;
}

void main() {
  int z = int(gl_WorkGroupID.z), first = int(gl_GlobalInvocationID.x), most = cells_of_colour(), stride = groups * LOCAL_SIZE_X;
  int right = vector_at(z, RIGHT), solution = vector_at(z, SOLUTION), residual = vector_at(z, RESIDUAL),
      direction = vector_at(z, DIRECTION), along = vector_at(z, ALONG);
  bool speaks = lane == 0 && gl_WorkGroupID.x == 0u;  // for all of a system
  int now = SUM_OF_SCALED + (iteration + 1) % 2, other = SUM_OF_SCALED + iteration % 2;
  if (stage == STAGE_ELIMINATED) {  // the solution in cells of colour 0, by those around
    for (int i = first; i < most; i += stride) {
      int cell = cell_of_colour(i, 0);
      if (cell >= 0) vectors[solution + cell] = inverse_of(cell) * (vectors[right + cell] + around(cell, solution));
    }
    return;
  }
  if (stage == STAGE_BEGIN) {  // `iteration` is 1
    double whole = sqrt(sum_of(SUM_OF_RIGHT)), squares = 0, scaled = 0;
    for (int i = first; i < most; i += stride) {
      int cell = cell_of_colour(i, 1);
      if (cell < 0) continue;
      double here = 0;
      if (whole > 0)
        here = vectors[right + cell] - diagonal_of(cell) * vectors[solution + cell] + around(cell, solution);
      else
        vectors[solution + cell] = 0;
      vectors[residual + cell] = here;
      squares += here * here;
      scaled += here * here * inverse_of(cell);
    }
    keep(SUM_OF_SQUARES, squares);
    keep(now, scaled);
    if (!speaks) return;
    states[first_system + z].whole = whole;
    states[first_system + z].done = 0;
    return;
  }
  if (stage == STAGE_TURN) {  // what was reached before this iteration, and its direction
    double squares = sum_of(SUM_OF_SQUARES), scaled = sum_of(now), before = sum_of(other);
    bool goes_on = iteration <= most_iterations && sqrt(squares) > tolerance * states[first_system + z].whole;
    double share = iteration > 1 && before > 0 ? scaled / before : 0.0LF;
    for (int i = first; i < most && goes_on; i += stride) {
      int cell = cell_of_colour(i, 1);
      if (cell < 0) continue;
      double here = inverse_of(cell) * vectors[residual + cell];
      if (share != 0) here += share * vectors[direction + cell];
      vectors[direction + cell] = here;
    }
    if (!speaks || states[first_system + z].done != 0) return;
    states[first_system + z].square = squares;
    states[first_system + z].iterations = iteration - 1;
    states[first_system + z].done = goes_on ? 0 : 1;
    return;
  }
  if (states[first_system + z].done != 0) return;  // of a dispatch before, for all lanes
  if (stage == STAGE_HALF) {                       // what cells of colour 0 are for the direction of the others
    for (int i = first; i < most; i += stride) {
      int cell = cell_of_colour(i, 0);
      if (cell >= 0) vectors[along + cell] = inverse_of(cell) * around(cell, direction);
    }
  } else if (stage == STAGE_ALONG) {  // the matrix times the direction
    double sum = 0;
    for (int i = first; i < most; i += stride) {
      int cell = cell_of_colour(i, 1);
      if (cell < 0) continue;
      double here = vectors[direction + cell], there = diagonal_of(cell) * here - around(cell, along);
      vectors[along + cell] = there;
      sum += here * there;
    }
    keep(SUM_OF_ALONG, sum);
  } else {  // STAGE_STEP
    double bend = sum_of(SUM_OF_ALONG), scaled = sum_of(now), squares = 0, sum = 0;
    double step_ = bend > 0 ? scaled / bend : 0.0LF;
    for (int i = first; i < most; i += stride) {
      int cell = cell_of_colour(i, 1);
      if (cell < 0) continue;
      double left = vectors[residual + cell] - step_ * vectors[along + cell];
      vectors[solution + cell] += step_ * vectors[direction + cell];
      vectors[residual + cell] = left;
      squares += left * left;
      sum += left * left * inverse_of(cell);
    }
    keep(SUM_OF_SQUARES, squares);
    keep(other, sum);
  }
}
