// Conjugate gradients for the normal equations of least squares: a number of steps of every system that is not done.
#include "legendre_fluids/paper.glsl"
uniform int steps;
uniform double tolerance;
#define solution (base + SOLUTION_AT)
#define residual_ (base + VECTORS_AT)
#define search (residual_ + UNKNOWNS)
#define image (search + UNKNOWNS)    // of the search by the equation
#define normal (image + UNKNOWNS)    // by the normal equations

// Rows of inflow, times their transposed: of coefficient e.
double inflow_rows(int e) {
  ivec3 index = index_of(e);
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    double there = 0;
    for (int k = 0; k < N[a]; ++k) there += end_of(a, k) * work[search + e + (k - index[a]) * strides[a]];
    sum += inflow_weight(a) * end_of(a, index[a]) * there;
  }
  return sum;
}

void step_on() {
  apply(false, search, image);
  apply(true, image, normal);
  double scale = per_rate() * per_rate();
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) work[normal + e] = scale * work[normal + e] + inflow_rows(e);
  together();
  double before = dot_of(residual_, residual_), share = before / dot_of(search, normal);
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) {
    work[solution + e] += share * work[search + e];
    work[residual_ + e] -= share * work[normal + e];
  }
  together();
  double after = dot_of(residual_, residual_);
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) work[search + e] = work[residual_ + e] + after / before * work[search + e];
  if (lane == 0) {
    RESIDUAL = sqrt(after) / SIZE_OF_RIGHT;
    STEPS_DONE += 1;
    DONE = RESIDUAL <= tolerance || STEPS_DONE >= ROOM ? 1 : 0;
  }
  together();
}

void main() {
  for (int s = 0; s < steps; ++s) {
    if (DONE != 0) break;  // uniform over all lanes
    step_on();
  }
}
