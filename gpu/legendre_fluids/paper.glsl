// Light of one medium as linear systems for Legendre coefficients: methods/legendre_fluids/light_system.h without matrices, in double
// precision. A system is a work group's, its numbers lie in `work`. UNKNOWNS = N.x N.y N.z coefficients, products are taken at M.x M.y M.z
// points; where tables and parts of `work` begin are definitions of paper_light.cpp.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_TABLES) readonly buffer Tables { double tables[]; };
layout(std430, binding = AT_POINTS) buffer Points { double density[]; };  // there; after it what scatters of it, where that is a field
int of_density = 0;                                                        // which of these `product` takes
layout(std430, binding = AT_WORK) coherent buffer Work { double work[]; };
uniform double sigma_t[SYSTEMS];  // [1/m]
uniform int directions[SYSTEMS];  // of the light that a system is about
#define system int(gl_WorkGroupID.x)
#define base (system * STRIDE)
#define direction_at (DIRECTIONS_AT + directions[system] * DIRECTION_STRIDE)
#define SCALARS_OF(i) work[base + SCALARS_AT + i]
// Scalars of a system.
#define SIZE_OF_RIGHT SCALARS_OF(0)
#define STEPS_DONE SCALARS_OF(1)
#define RESIDUAL SCALARS_OF(2)  // over the right side; `lost` where something is no number
#define DONE SCALARS_OF(3)
const double lost = 1e300LF;
bool is_number(double size) { return size >= 0 && size < lost; }  // of what is no less than 0
#include "legendre_fluids/tensors.glsl"

double dot_of(int a, int b) {
  double sum = 0;
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) sum += work[a + e] * work[b + e];
  return total(sum);
}

// Transforms coefficients of any shape to the points. The result is in `one`; `two` is overwritten.
void to_points(ivec3 shape, ivec3 table, ivec3 row_steps, ivec3 column_steps, int from, int one, int two) {
  transform(table.x, ivec2(row_steps.x, column_steps.x), M.x, shape.x, 1, shape.y * shape.z, from, one);
  transform(table.y, ivec2(row_steps.y, column_steps.y), M.y, shape.y, M.x, shape.z, one, two);
  transform(table.z, ivec2(row_steps.z, column_steps.z), M.z, shape.z, M.x * M.y, 1, two, one);
}

// A field times the density, cut to N coefficients again, or the transposed map: into the second of two regions, whose place it gives.
int product(bool transposed, int from) {
  int one = base + ROOM_AT, two = one + REGION;
  if (transposed)
    to_points(N, ANALYSIS_AT, ivec3(1), M, from, one, two);
  else
    to_points(N, VALUES_AT, N, ivec3(1), from, one, two);
  for (int e = lane; e < ALL_POINTS; e += LOCAL_SIZE_X) work[one + e] *= density[of_density * ALL_POINTS + e];
  together();
  ivec3 table = transposed ? VALUES_AT : ANALYSIS_AT, rows = transposed ? ivec3(1) : M, columns = transposed ? N : ivec3(1);
  transform(table.z, ivec2(rows.z, columns.z), N.z, M.z, M.x * M.y, 1, one, two);
  transform(table.y, ivec2(rows.y, columns.y), N.y, M.y, M.x, N.z, two, one);
  transform(table.x, ivec2(rows.x, columns.x), N.x, M.x, 1, N.y * N.z, one, two);
  return two;
}

const ivec3 strides = ivec3(N.y * N.z, N.z, 1), alongs = ivec3(0, N.x * N.x, N.x * N.x + N.y * N.y);
ivec3 index_of(int e) { return ivec3(e / strides.x, e / N.z % N.y, e % N.z); }

// The left side omega.grad E + sigma r E, of upwind with its inflow, or the transposed one. `to` is not `from`.
void apply(bool transposed, int from, int to) {
  int with_density = product(transposed, from);
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) {
    ivec3 index = index_of(e);
    double sum = sigma_t[system] * work[with_density + e];
    for (int a = 0; a < 3; ++a) {
      int at = direction_at + alongs[a] + index[a] * (transposed ? 1 : N[a]), step_ = transposed ? N[a] : 1;
      int first = from + e - index[a] * strides[a];
      for (int k = 0; k < N[a]; ++k) sum += tables[at + k * step_] * work[first + k * strides[a]];
    }
    work[to + e] = sum;
  }
  together();
}

// The basis at the inflow end of an axis (0: there is none), what a miss there counts, 1 over the length of the rate.
double end_of(int a, int i) { return tables[direction_at + ENDS_AT[a] + i]; }
double inflow_weight(int a) { return tables[direction_at + WEIGHTS_AT + a]; }
double per_rate() { return tables[direction_at + WEIGHTS_AT + 3]; }
