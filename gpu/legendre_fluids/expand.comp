// A slab of one field, a work group each: ends what the last dispatches began (a stage of Runge-Kutta, a projection, a step), then goes
// on along y and z, to Gauss points or to the modes of diffusion.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "legendre_fluids/slab.glsl"
layout(std430, binding = AT_START) readonly buffer Start { float start[]; };  // the state to begin with
layout(std430, binding = AT_STATE) buffer State { float state[]; };
layout(std430, binding = AT_RATES) buffer Rates { float rates[]; };  // by field: of this stage, then their sum so far
layout(std430, binding = AT_PRESSURE) readonly buffer Pressure { float pressure[]; };
layout(std430, binding = AT_SPREAD) writeonly buffer Spread { float spread[]; };
layout(std430, binding = AT_STATUS) buffer Status { uint status[]; };
uniform int first_field, adds, stage, goes_on, ends, begins;
uniform float dt;                                        // [s] of a step of Runge-Kutta
uniform vec3 per_area;                                   // half size^-2 of each axis
uniform float filters_velocity, filters_carried;         // rate times time
#if SCALARS > 0
uniform float fades[SCALARS];  // what decay leaves of what is carried, before the step or after it
#endif
#if SOURCES * SCALARS > 0
layout(std430, binding = AT_REGIONS) readonly buffer Regions { float regions[]; };
uniform float amounts[SOURCES * SCALARS];  // of each source, of each of what is carried
#endif

float added_by_sources(int field, int place) {
  float sum = 0;
#if SOURCES * SCALARS > 0
  if (field < D) return 0;
  for (int i = 0; i < SOURCES; ++i)
    sum += amounts[i * SCALARS + field - D] * regions[i * SIZE + place];
#endif
  return sum;
}

float faded(int field) {
#if SCALARS > 0
  if (field >= D) return fades[field - D];
#endif
  return 1;
}

// Factor of filters and decay on coefficient (i, j, k) at the end of a step.
float left_over(int field, int i, int j, int k) {
  float rate = field < D ? filters_velocity : filters_carried;
  float sum = number(TABLE_POWERS, i) + number(TABLE_POWERS, j) + number(TABLE_POWERS, k);
  return (rate > 0 ? exp(-min(rate * sum, 200)) : 1) * faded(field);
}

// The pressure along z, so that the line is what its column has along y.
void begin_gradient(int field, int slab) {
  int from = (field == 0 ? SIZE : 0) + slab * SLAB;
  for (int e = lane; e < SLAB; e += LOCAL_SIZE_X) work[e] = pressure[from + e];
  barrier();
  if (lane < N) {
    take(SQUARE_FOURS_Z, NZ, lane * NZ, 1);
    int table = D == 3 && field == 2 ? TABLE_LIFT : TABLE_PRESSURE_MODES;
    for (int k = 0; k < NZ; ++k) work[ROOM + lane * NZ + k] = row_times_line(table, SQUARE_FOURS_Z, k);
  }
  barrier();
  if (lane < NZ) take(SQUARE_FOURS, N, ROOM + lane, NZ);
}

// A coefficient of now, and what the rest of the step needs to know of it.
float updated(int field, int slab, int j, int k, float more) {
  int place = slab * SLAB + j * NZ + k, at = field * SIZE + place;
  float value = start[at];
  if (begins != 0) value = faded(field) * value + added_by_sources(field, place);
  if (stage >= 0) {
    float rate = rates[at] + more, sum = stage == 0 ? 0 : rates[FIELDS * SIZE + at];
    sum += stage == 1 || stage == 2 ? 2 * rate : rate;
    rates[FIELDS * SIZE + at] = sum;
    value += stage == 3 ? dt / 6 * sum : (stage == 2 ? 1 : 0.5) * dt * rate;
  } else {
    value += more;
  }
  if (ends != 0) {
    value = (value + added_by_sources(field, place)) * left_over(field, slab, j, k);
    if ((floatBitsToUint(value) & 0x7f800000u) == 0x7f800000u) atomicOr(status[1], 1u);
  }
  if (stage < 0 || stage == 3) state[at] = value;
  return value;
}

// From `work`: along z to values (kind 0) or slopes (2), then along y to values, for kind 1 slopes.
void along_z(int table) {
  if (lane < N) {
    combine(table, FOURS_Z, NZ, lane * NZ, 1);
    put(FOURS_Z, POINTS_Z, ROOM + lane * POINTS_Z, 1);
  }
  barrier();
}
void along_y(int table, int field, int slab, int kind) {
  if (lane >= POINTS_Z) return;
  combine(table, FOURS, N, ROOM + lane, POINTS_Z);
  int to = ((field * 3 + kind) * N + slab) * LINES + lane;
  for (int b = 0; b < FOURS; ++b)
    for (int c = 0; c < 4; ++c)
      if (4 * b + c < POINTS) spread[to + (4 * b + c) * POINTS_Z] = line[b][c];
}

void to_points(int field, int slab) {
  int values = basis_at(TABLE_VALUES, field, 1);
  along_z(D == 3 ? basis_at(TABLE_VALUES, field, 2) : TABLE_PRESSURE_MODES);
  along_y(values, field, slab, 0);
  along_y(basis_at(TABLE_SLOPES, field, 1), field, slab, 1);
#if D == 3
  barrier();
  along_z(basis_at(TABLE_SLOPES, field, 2));
  along_y(values, field, slab, 2);
#endif
}

void to_modes(int field, int slab) {
  if (lane < N) {
    combine(D == 3 ? modes_at(field, 2) : TABLE_PRESSURE_MODES, SQUARE_FOURS_Z, NZ, lane * NZ, 1);
    put(SQUARE_FOURS_Z, NZ, ROOM + lane * NZ, 1);
  }
  barrier();
  if (lane >= NZ) return;
  combine(modes_at(field, 1), SQUARE_FOURS, N, ROOM + lane, NZ);
  int to = field * SIZE + slab * SLAB + lane;
  for (int b = 0; b < SQUARE_FOURS; ++b)
    for (int c = 0; c < 4; ++c)
      if (4 * b + c < N) spread[to + (4 * b + c) * NZ] = line[b][c];
}

void main() {
  int slab = int(gl_WorkGroupID.x), field = first_field + int(gl_WorkGroupID.y);
  bool projected = adds != 0 && field < D;
  if (begins != 0 && slab == 0 && field == first_field && lane < 2) status[lane] = 0u;
  if (projected) begin_gradient(field, slab);
  int lift = field == 1 ? TABLE_LIFT : TABLE_PRESSURE_MODES;
  for (int j = 0; j < N && lane < NZ; ++j) {
    float more = projected ? per_area[field] * row_times_line(lift, SQUARE_FOURS, j) : 0;
    work[j * NZ + lane] = updated(field, slab, j, lane, more);
  }
  barrier();
  if (goes_on == GOES_TO_POINTS) to_points(field, slab);
  if (goes_on == GOES_TO_MODES) to_modes(field, slab);
}
