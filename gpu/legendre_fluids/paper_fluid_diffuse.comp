// Diffusion after advection, a work group for each field: equation 16, whose series ends because D^2 is nilpotent; of the repaired variant
// the exact factors of what is carried.
#include "legendre_fluids/paper_fluid.glsl"
uniform int first_field;
uniform double velocity_amount, carried_amount;  // viscosity and diffusivity times time [m^2]
uniform dvec3 per_area;                          // half size^-2 of each axis

void sum_series(int base, int field) {
  int term = base + ONE_AT, next = base + TWO_AT;
  double amount = field < D ? velocity_amount : carried_amount;
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) work[term + e] = state[field * SIZE + e];
  together();
  for (int degree = D * (N - 1); degree >= 2; degree -= 2) {
    for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) {
      double sum = 0;
      for (int a = 0; a < D; ++a) {
        int i = index_of(e, a), step_ = stride_of(a);
        double along = 0;
        for (int k = i + 2; k < N; ++k) along += tables[SECOND_AT + k * N + i] * work[term + e + (k - i) * step_];
        sum += per_area[a] * along;
      }
      sum *= amount;
      work[next + e] = sum;
      state[field * SIZE + e] += sum;
    }
    together();
    int last = term;
    term = next;
    next = last;
  }
}

#if REPAIRED
void take_factors(int base, int field) {
  const ivec2 columns = ivec2(1, N);
  int one = base + ONE_AT, two = base + TWO_AT;
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) work[one + e] = state[field * SIZE + e];
  together();
  const int carried = FACTORS_AT + 2 * N * N, axis = 3 * N * N;
  transform(carried, columns, N, N, 1, SLAB, one, two);
  transform(carried + axis, columns, N, N, N, NZ, two, one);
#if D == 3
  transform(carried + 2 * axis, columns, N, N, N * N, 1, one, two);
  one = two;
#endif
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) state[field * SIZE + e] = work[one + e];
}
#endif

void main() {
  int field = first_field + int(gl_WorkGroupID.x), base = field * STRIDE;
  for (int f = 0; f < FIELDS; ++f)
    if (DONE(f) == 0) return;
#if REPAIRED
  take_factors(base, field);
#else
  sum_series(base, field);
#endif
}
