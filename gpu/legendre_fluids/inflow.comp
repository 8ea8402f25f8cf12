// Air that comes in, a work group for each carried field: scalar_inflow of methods/legendre_fluids/confined_space.h. On each side
// (w.n)(r - r_in) where w.n < 0, tested with the functions of the field, is added to the rates of points.comp. They are coefficients along
// x and values at the points along y and z. A side along y or z adds the values of a polynomial whose projection has the functions' values
// at that side.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "legendre_fluids/fields.glsl"
layout(std430, binding = AT_SPREAD) readonly buffer Spread { float spread[]; };
layout(std430, binding = AT_GATHERED) buffer Gathered { float gathered[]; };
uniform float incoming[6 * SCALARS];  // r_in of each field, by axis, the low side first
#include "legendre_fluids/wind.glsl"
shared float face[N * POINTS], flux[POINTS * POINTS];
#define lane int(gl_LocalInvocationID.x)

// L_i at an end of the axis.
float end_value(int side, int i) { return (side == 0 && i % 2 == 1 ? -1 : 1) * sqrt(float(i) + 0.5); }

// Rate at a point of a side, for an excess of the field over what comes in.
float rate(int axis, int side, vec3 at, float excess) {
  float speed = wind[axis];
  for (int b = 0; b < D; ++b) speed += wind_slopes[b][axis] * at[b];
  return -max(side == 0 ? speed : -speed, 0) * excess;
}

void along_x(int field, int side, float r_in) {
  for (int l = lane; l < LINES; l += LOCAL_SIZE_X) {
    float value = 0;
    for (int i = 0; i < N; ++i) value += end_value(side, i) * spread[(3 * field * N + i) * LINES + l];
    vec3 at = vec3(2 * side - 1, node(l / POINTS_Z), D == 3 ? node(l % POINTS_Z) : 0);
    float change = rate(0, side, at, value - r_in);
    for (int i = 0; i < N; ++i) gathered[(field * N + i) * LINES + l] += end_value(side, i) * change;
  }
  barrier();
}

// Axis 1 or 2; the other one of these two has `others` points.
void along(int axis, int field, int side, float r_in) {
  int others = axis == 1 ? POINTS_Z : POINTS, step_ = axis == 1 ? POINTS_Z : 1, other_step = axis == 1 ? 1 : POINTS_Z;
  int to_end = TABLE_TO_ENDS + side * FOURS, from_end = TABLE_FROM_ENDS + side * FOURS;
  for (int e = lane; e < N * others; e += LOCAL_SIZE_X) {
    int i = e / others, from = (3 * field * N + i) * LINES + e % others * other_step;
    float sum = 0;
    for (int q = 0; q < POINTS; ++q) sum += number(to_end, q) * spread[from + q * step_];
    face[e] = sum;
  }
  barrier();
  for (int e = lane; e < POINTS * others; e += LOCAL_SIZE_X) {
    int p = e / others, other = e % others;
    float value = 0, end = float(2 * side - 1), there = D == 3 ? node(other) : 0;
    for (int i = 0; i < N; ++i) value += number(TABLE_VALUES + i * FOURS, p) * face[i * others + other];
    flux[e] = rate(axis, side, axis == 1 ? vec3(node(p), end, there) : vec3(node(p), there, end), value - r_in);
  }
  barrier();
  for (int e = lane; e < N * others; e += LOCAL_SIZE_X) {
    int i = e / others, other = e % others, to = (field * N + i) * LINES + other * other_step;
    float sum = 0;
    for (int p = 0; p < POINTS; ++p) sum += number(TABLE_FROM_POINTS + i * FOURS, p) * flux[p * others + other];
    for (int q = 0; q < POINTS; ++q) gathered[to + q * step_] += number(from_end, q) * sum;
  }
  barrier();
}

void main() {
  int scalar = int(gl_WorkGroupID.x), field = D + scalar;
  for (int side = 0; side < 2; ++side) {
    along_x(field, side, incoming[6 * scalar + side]);
    along(1, field, side, incoming[6 * scalar + 2 + side]);
#if D == 3
    along(2, field, side, incoming[6 * scalar + 4 + side]);
#endif
  }
}
