// Equation 14, exp(-dt A) of a field's coefficients, by its series: a number of steps of it, or fewer where it ends. A work group for each
// field.
#include "legendre_fluids/paper_fluid.glsl"
#include "legendre_fluids/paper_fluid_points.glsl"
layout(std430, binding = AT_POINTS) readonly buffer Speeds { double speeds[]; };  // the velocity along each axis, at the points
uniform int steps, first_field;
uniform double dt;             // [s]
const double most_parts = 2e4LF;  // of a step: parts_of_advection
const int most_terms = 60;     // of a part
#define LAST (M * MZ * N)      // numbers at the points of all axes but the last

// From the points along the last axis, times the velocity: the derivative along that axis, the cut value for the others.
void along_last(int one, int two) {
  for (int e = lane; e < LAST; e += LOCAL_SIZE_X) {
    int row = e % N, first = e / N * M;
    double sloped = 0, x = 0, y = 0;
    for (int q = 0; q < M; ++q) {
      int at = first + q;
      double value = work[one + at], cut = tables[CUT_AT + q * N + row] * value;
      sloped += tables[SLOPE_AT + q * N + row] * value * speeds[(D - 1) * ALL_POINTS + at];
      x += cut * speeds[at];
      if (D == 3) y += cut * speeds[ALL_POINTS + at];
    }
    work[two + e] = x;
    if (D == 3) work[two + LAST + e] = y;
    work[two + (D - 1) * LAST + e] = sloped;
  }
  together();
}

// In three dimensions along y: what is to be derived along x, and the rest.
void along_y(int two, int three) {
  for (int e = lane; e < M * SLAB; e += LOCAL_SIZE_X) {
    int row = e / N % N, first = two + e / SLAB * M * N + e % N;
    double x = 0, rest = 0;
    for (int q = 0; q < M; ++q) {
      int at = first + q * N;
      double cut = tables[CUT_AT + q * N + row];
      x += cut * work[at];
      rest += tables[SLOPE_AT + q * N + row] * work[at + LAST] + cut * work[at + 2 * LAST];
    }
    work[three + e] = x;
    work[three + M * SLAB + e] = rest;
  }
  together();
}

// The term becomes `factor` A term and is added to the field. Returns its square's sum.
double next_term(int base, int field, double factor) {
  to_points(base);
  along_last(base + ONE_AT, base + TWO_AT);
#if D == 3
  along_y(base + TWO_AT, base + THREE_AT);
  int x = base + THREE_AT, rest = x + M * SLAB;
#else
  int x = base + TWO_AT, rest = x + LAST;
#endif
  double squares = 0;
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) {
    int row = e / SLAB, i = e % SLAB;
    double sum = 0;
    for (int q = 0; q < M; ++q)
      sum += tables[SLOPE_AT + q * N + row] * work[x + q * SLAB + i] + tables[CUT_AT + q * N + row] * work[rest + q * SLAB + i];
    sum *= factor;
    work[base + TERM_AT + e] = sum;
    state[field * SIZE + e] += sum;
    squares += sum * sum;
  }
  together();
  return total(squares);
}

double begin_part(int base, int field) {
  double squares = 0;
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) {
    double value = state[field * SIZE + e];
    work[base + TERM_AT + e] = value;
    squares += value * value;
  }
  together();
  return total(squares);
}

void main() {
  int field = first_field + int(gl_WorkGroupID.x), base = field * STRIDE;
  double rate = 0;
  for (int a = 0; a < D; ++a) rate += GREATEST(a) * (N * N);
  double parts = ceil(dt * rate);
  if (DONE(field) != 0 || !(parts <= most_parts)) return;  // the host objects to so many parts
  int count = max(1, int(parts)), part = int(PART(field)), next = int(NEXT(field)), step_ = 0;
  double small = SMALL(field), norm = NORM(field);
  together();
  for (; step_ < steps && part < count; ++step_) {
    if (next == 0) {
      norm = sqrt(begin_part(base, field));
      small = 1e-17LF * norm;
      next = 1;
    }
    if (next < most_terms && norm > small) {
      norm = sqrt(next_term(base, field, -dt / count / next));
      ++next;
    } else {
      ++part;
      next = 0;
    }
  }
  if (lane > 0) return;
  PART(field) = part;
  NEXT(field) = next;
  STEPS(field) += step_;
  SMALL(field) = small;
  NORM(field) = norm;
  DONE(field) = part >= count ? 1 : 0;
}
