// A slab of the velocity, or of one scalar, a work group each: back along y and z to coefficients, from Gauss points, from the modes of
// diffusion, or with forces added; of the velocity then the divergence, on its way to the modes of pressure.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "legendre_fluids/slab.glsl"
layout(std430, binding = AT_STATE) buffer State { float state[]; };
layout(std430, binding = AT_RATES) writeonly buffer Rates { float rates[]; };
layout(std430, binding = AT_PRESSURE) writeonly buffer Pressure { float pressure[]; };
layout(std430, binding = AT_SPREAD) readonly buffer Spread { float spread[]; };
layout(std430, binding = AT_GATHERED) readonly buffer Gathered { float gathered[]; };
uniform int comes_from, velocity, first_scalar;  // is the first group that of the velocity; the scalar of the next
#if SCALARS > 0
uniform vec3 weights[SCALARS];  // half sizes a second, by 1 of what is carried
#endif
#if PUSHES > 0
layout(std430, binding = AT_REGIONS) readonly buffer Regions { float regions[]; };
uniform vec3 push_amounts[PUSHES];
#endif

// Change by forces along an axis, as a scalar: its coefficient at a place of SIZE.
float force(int axis, int place) {
  float sum = 0;
#if SCALARS > 0
  for (int r = 0; r < SCALARS; ++r) sum += weights[r][axis] * state[(D + r) * SIZE + place];
#endif
#if PUSHES > 0
  for (int p = 0; p < PUSHES; ++p) sum += push_amounts[p][axis] * regions[(SOURCES + p) * SIZE + place];
#endif
  return sum;
}

// The force as a coefficient of the velocity component along the axis.
float pushed(int axis, int slab, int j, int k) {
  int index = axis == 0 ? slab : axis == 1 ? j : k, step_ = axis == 0 ? SLAB : axis == 1 ? NZ : 1;
  int first = slab * SLAB + j * NZ + k - index * step_;
  float sum = 0;
  for (int i = 0; i < N; ++i) sum += number(TABLE_FROM_SCALAR + index * SQUARE_FOURS, i) * force(axis, first + i * step_);
  return sum;
}

// Back along y, so that the line is what its row has along z.
void begin_back(int field, int slab) {
  barrier();
  if (comes_from == COMES_FROM_POINTS) {
    int from = (field * N + slab) * LINES + lane, table = basis_at(TABLE_FROM_POINTS, field, 1);
    if (lane < POINTS_Z) {
      for (int b = 0; b < FOURS; ++b)
        for (int c = 0; c < 4; ++c) line[b][c] = 4 * b + c < POINTS ? gathered[from + (4 * b + c) * POINTS_Z] : 0;
      for (int j = 0; j < N; ++j) work[ROOM + j * POINTS_Z + lane] = row_times_line(table, FOURS, j);
    }
    barrier();
    if (lane < N) take(FOURS_Z, POINTS_Z, ROOM + lane * POINTS_Z, 1);
  } else {
    int from = field * SIZE + slab * SLAB + lane, table = modes_at(field, 1);
    if (lane < NZ) {
      for (int b = 0; b < SQUARE_FOURS; ++b)
        for (int c = 0; c < 4; ++c) line[b][c] = 4 * b + c < N ? spread[from + (4 * b + c) * NZ] : 0;
      for (int j = 0; j < N; ++j) work[ROOM + j * NZ + lane] = row_times_line(table, SQUARE_FOURS, j);
    }
    barrier();
    if (lane < N) take(SQUARE_FOURS_Z, NZ, ROOM + lane * NZ, 1);
  }
}

// One coefficient of the row, also to where it belongs.
float collected(int field, int slab, int k) {
  int at = field * SIZE + slab * SLAB + lane * NZ + k;
  if (comes_from == COMES_FROM_POINTS) {
    float rate = row_times_line(D == 3 ? basis_at(TABLE_FROM_POINTS, field, 2) : TABLE_PRESSURE_MODES, FOURS_Z, k);
    rates[at] = rate;
    return rate;
  }
  if (comes_from == COMES_FROM_MODES)
    return state[at] = row_times_line(D == 3 ? modes_at(field, 2) : TABLE_PRESSURE_MODES, SQUARE_FOURS_Z, k);
  return state[at] += pushed(field, slab, lane, k);
}

void main() {
  int slab = int(gl_WorkGroupID.x), group = int(gl_WorkGroupID.y);
  if (group >= velocity) {
    int field = first_scalar + group - velocity;
    begin_back(field, slab);
    for (int k = 0; k < NZ && lane < N; ++k) collected(field, slab, k);
    return;
  }
  for (int a = 0; a < D; ++a) {
    if (comes_from != COMES_FROM_FORCES) begin_back(a, slab);
    // phi_i' = L_i: components add at equal indices, into the divergence.
    for (int k = 0; k < NZ && lane < N; ++k) {
      float c = collected(a, slab, k);
      work[lane * NZ + k] = a == 0 ? c : work[lane * NZ + k] + c;
    }
  }
  barrier();
  if (lane < N) {
    combine(TABLE_PRESSURE_MODES, SQUARE_FOURS_Z, NZ, lane * NZ, 1);
    put(SQUARE_FOURS_Z, NZ, ROOM + lane * NZ, 1);
  }
  barrier();
  if (lane >= NZ) return;
  combine(TABLE_PRESSURE_MODES, SQUARE_FOURS, N, ROOM + lane, NZ);
  for (int b = 0; b < SQUARE_FOURS; ++b)
    for (int c = 0; c < 4; ++c)
      if (4 * b + c < N) pressure[slab * SLAB + (4 * b + c) * NZ + lane] = line[b][c];
}
