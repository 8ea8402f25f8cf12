// Begins a step: sources add to what is carried; the velocity at the points, with its greatest size along each axis. A work group for each
// field.
#include "legendre_fluids/paper_fluid.glsl"
#include "legendre_fluids/paper_fluid_points.glsl"
layout(std430, binding = AT_START) readonly buffer Start { double start[]; };  // the state to begin with
layout(std430, binding = AT_POINTS) writeonly buffer Speeds { double speeds[]; };  // of each axis, at the points
#if SOURCES * SCALARS > 0
uniform double amounts[SOURCES * SCALARS];  // of each source, of each of what is carried
#endif

double added_by_sources(int field, int e) {
  double sum = 0;
#if SOURCES * SCALARS > 0
  if (field < D) return 0;
  for (int i = 0; i < SOURCES; ++i) sum += amounts[i * SCALARS + field - D] * tables[REGIONS_OF_SOURCES + i * SIZE + e];
#endif
  return sum;
}

// Greatest of all lanes, returned to all of them.
double greatest(double mine) {
  partial[lane] = mine;
  barrier();
  for (int half_ = LOCAL_SIZE_X / 2; half_ > 0; half_ /= 2) {
    if (lane < half_) partial[lane] = max(partial[lane], partial[lane + half_]);
    barrier();
  }
  double most = partial[0];
  barrier();
  return most;
}

void main() {
  int field = int(gl_WorkGroupID.x), base = field * STRIDE;
  double lost = 0, most = 0, squares = 0;
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) {
    double value = start[field * SIZE + e] + added_by_sources(field, e);
    state[field * SIZE + e] = value;
    work[base + TERM_AT + e] = value;
    squares += value * value;
    if (is_lost(value)) lost = 1;
  }
  together();
  lost = greatest(lost);
  squares = total(squares);
  if (field < D) {
    to_points(base);
    for (int e = lane; e < ALL_POINTS; e += LOCAL_SIZE_X) {
      double speed = work[base + ONE_AT + e];
      speeds[field * ALL_POINTS + e] = speed;
      most = max(most, abs(speed));
    }
    most = greatest(most);
  }
  if (lane > 0) return;
  GREATEST(field) = most;
  LOST(field) = lost;
  DONE(field) = field < D && MOVES == 0 ? 1 : 0;
  STEPS(field) = 0;
  PART(field) = 0;
  NEXT(field) = 0;
  SMALL(field) = 0;
  NORM(field) = 0;
  SQUARES(field) = squares;
}
