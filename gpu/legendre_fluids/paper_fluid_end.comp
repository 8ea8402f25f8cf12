// The rest of a step, by a single work group: of the repaired variant projection and diffusion of the velocity, then forces (equation 17),
// the last projection (equations 19 and 20), decay (equation 21).
#include "legendre_fluids/paper_fluid.glsl"
layout(std430, binding = AT_FLOATS) writeonly buffer Floats { float floats[]; };  // the state in single precision, for who reads that
uniform int pushes, diffuses;         // do forces act; has the repaired variant's velocity a viscosity
uniform dvec3 per_area, areas;        // half size^-2 of each axis, half size^2
#if SCALARS > 0
uniform double fades[SCALARS];   // what decay leaves
uniform dvec3 weights[SCALARS];  // half sizes a second, by 1 of what is carried
#endif
#if PUSHES > 0
uniform dvec3 push_amounts[PUSHES];
#endif
const int a_at = ONE_AT, b_at = a_at + SIZE, pressure_at = b_at + SIZE;

double energy() {
  double sum = 0;
  for (int e = lane; e < D * SIZE; e += LOCAL_SIZE_X) sum += areas[e / SIZE] * state[e] * state[e];
  return total(sum);
}

double force(int axis, int e) {
  double sum = 0;
#if SCALARS > 0
  for (int r = 0; r < SCALARS; ++r) sum += weights[r][axis] * state[(D + r) * SIZE + e];
#endif
#if PUSHES > 0
  for (int p = 0; p < PUSHES; ++p) sum += push_amounts[p][axis] * tables[REGIONS_OF_PUSHES + p * SIZE + e];
#endif
  return sum;
}

// The derivative along an axis of the coefficients at `from`, at coefficient e of them.
double slope(int from, int e, int axis, bool of_state) {
  int i = index_of(e, axis), step_ = stride_of(axis);
  double sum = 0;
  for (int k = i + 1; k < N; k += 2) {
    int at = from + e + (k - i) * step_;
    sum += tables[DERIVATIVE_AT + k * N + i] * (of_state ? state[at] : work[at]);
  }
  return sum;
}

#if REPAIRED
void take(int from, bool of_state) {
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) work[a_at + e] = of_state ? state[from + e] : work[from + e];
  together();
}
// What was taken, by a matrix along each axis; returns where it is.
int along_axes(ivec3 matrix) {
  const ivec2 columns = ivec2(1, N);
  transform(matrix.x, columns, N, N, 1, SLAB, a_at, b_at);
  transform(matrix.y, columns, N, N, N, NZ, b_at, a_at);
  if (D == 2) return a_at;
  transform(matrix.z, columns, N, N, N * N, 1, a_at, b_at);
  return b_at;
}
ivec3 matrices(int axis, int own, int other) {
  return ivec3(axis == 0 ? own : other, axis == 1 ? own : other, axis == 2 ? own : other);
}

// The velocity's L2 projection onto what is confined, and without divergence.
void project() {
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) work[pressure_at + e] = 0;
  for (int axis = 0; axis < D; ++axis) {
    take(axis * SIZE, true);
    int divergence = along_axes(matrices(axis, TO_MODES_OWN_AT, TO_MODES_AT));
    for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) work[pressure_at + e] += work[divergence + e];
    together();
  }
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) work[pressure_at + e] *= tables[PRESSURE_AT + e];
  together();
  for (int axis = 0; axis < D; ++axis) {
    take(axis * SIZE, true);
    int confined = along_axes(matrices(axis, CONFINED_OWN_AT, CONFINED_AT));
    for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) state[axis * SIZE + e] = work[confined + e];
    together();
    take(pressure_at, false);
    int gradient = along_axes(matrices(axis, GRADIENT_OWN_AT, GRADIENT_AT));
    for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) state[axis * SIZE + e] += per_area[axis] * work[gradient + e];
    together();
  }
}

// Where the factors along an axis are, of the component along another one.
int factors(int along, int axis) { return FACTORS_AT + (3 * along + (along == axis ? 0 : 1)) * N * N; }

void diffuse() {
  for (int axis = 0; axis < D; ++axis) {
    take(axis * SIZE, true);
    int at = along_axes(ivec3(factors(0, axis), factors(1, axis), factors(2, axis)));
    for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) state[axis * SIZE + e] = work[at + e];
    together();
  }
}
#else
void project() {
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) {
    double sum = 0;
    for (int a = 0; a < D; ++a) sum += slope(a * SIZE, e, a, true);
    work[a_at + e] = sum;
  }
  together();
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X) {
    double sum = 0;
    for (int c = 0; c < SIZE; ++c) sum += tables[INVERSE_AT + c * SIZE + e] * work[a_at + c];
    work[pressure_at + e] = sum;
  }
  together();
  for (int e = lane; e < SIZE; e += LOCAL_SIZE_X)
    for (int a = 0; a < D; ++a) state[a * SIZE + e] -= per_area[a] * slope(pressure_at, e, a, false);
  together();
}
#endif

void move() {
#if REPAIRED
  project();
  if (diffuses != 0) {
    diffuse();
    project();
  }
#endif
  double advected = energy(), pushed = advected;
  if (pushes != 0) {
    for (int e = lane; e < D * SIZE; e += LOCAL_SIZE_X) state[e] += force(e / SIZE, e % SIZE);
    together();
    pushed = energy();
  }
  if (pushes != 0 || REPAIRED == 0) project();
  double last = energy();
  if (lane > 0) return;
  ENERGY(0) = advected;
  ENERGY(1) = pushed;
  ENERGY(2) = last;
}

void main() {
  for (int f = 0; f < FIELDS; ++f)
    if (DONE(f) == 0) return;
  if (MOVES != 0) move();
  double lost = 0;
  for (int e = lane; e < FIELDS * SIZE; e += LOCAL_SIZE_X) {
    double value = state[e];
    if (is_lost(value)) lost = 1;
#if SCALARS > 0
    if (e >= D * SIZE) value *= fades[e / SIZE - D];
#endif
    state[e] = value;
    floats[e] = float(value);
  }
  lost = total(lost);
  if (lane == 0) LOST_AT_END = lost;
}
