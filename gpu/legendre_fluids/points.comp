// Lines of Gauss points along x, one to an invocation: fields change by -w.grad at each point, then back to coefficients along x.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "legendre_fluids/fields.glsl"
layout(std430, binding = AT_SPREAD) readonly buffer Spread { float spread[]; };
layout(std430, binding = AT_GATHERED) writeonly buffer Gathered { float gathered[]; };
layout(std430, binding = AT_STATUS) buffer Status { uint status[]; };
uniform int measures;  // the greatest speed
shared uint fastest;
#if WIND
#include "legendre_fluids/wind.glsl"

// The wind along an axis at four points of a line.
vec4 wind_along(int a, int b, int line) {
  float y = node(line / POINTS_Z), z = D == 3 ? node(line % POINTS_Z) : 0;
  return wind[a] + wind_slopes[0][a] * matrices[TABLE_NODES + b] + wind_slopes[1][a] * y + wind_slopes[2][a] * z;
}
// The velocity moves itself; it and the wind move what is carried.
#define BLOW                                \
  for (int b = 0; b < FOURS; ++b)           \
    for (int a = 0; a < D; ++a) w[a * FOURS + b] += wind_along(a, b, line);
#endif

void main() {
  int line = min(int(gl_GlobalInvocationID.x), LINES - 1);  // the last ones do it again
  vec4 w[D * FOURS], squares = vec4(0);
  for (int a = 0; a < D; ++a) {
    for (int b = 0; b < FOURS; ++b) w[a * FOURS + b] = vec4(0);
    int values = basis_at(TABLE_VALUES, a, 0), from = a * 3 * N * LINES + line;
    for (int i = 0; i < N; ++i) {
      float value = spread[from + i * LINES];
      for (int b = 0; b < FOURS; ++b) w[a * FOURS + b] += matrices[values + i * FOURS + b] * value;
    }
  }
  for (int f = MOVES != 0 ? 0 : D; f < FIELDS; ++f) {
#if WIND
    if (f == D) BLOW
#endif
    vec4 along[FOURS], across[FOURS], rate[FOURS];
    int from = f * 3 * N * LINES + line, values = basis_at(TABLE_VALUES, f, 0), slopes = basis_at(TABLE_SLOPES, f, 0);
    for (int b = 0; b < FOURS; ++b) along[b] = across[b] = rate[b] = vec4(0);
    for (int i = 0; i < N; ++i) {
      float value = spread[from + i * LINES], slope_y = spread[from + (N + i) * LINES];
#if D == 3
      float slope_z = spread[from + (2 * N + i) * LINES];
#else
      float slope_z = 0;
#endif
      for (int b = 0; b < FOURS; ++b) {
        along[b] += matrices[slopes + i * FOURS + b] * value;
        across[b] += matrices[values + i * FOURS + b] * slope_y;
        rate[b] += matrices[values + i * FOURS + b] * slope_z;
      }
    }
    for (int b = 0; b < FOURS; ++b) {
      rate[b] = D == 3 ? rate[b] * w[(D - 1) * FOURS + b] : vec4(0);
      rate[b] = -(rate[b] + w[b] * along[b] + w[FOURS + b] * across[b]);
    }
    int back = basis_at(TABLE_FROM_POINTS, f, 0);
    for (int i = 0; i < N; ++i) {
      float sum = 0;
      for (int b = 0; b < FOURS; ++b) sum += dot(matrices[back + i * FOURS + b], rate[b]);
      gathered[(f * N + i) * LINES + line] = sum;
    }
  }
#if WIND && FIELDS == D
  BLOW
#endif
  if (measures == 0) return;
  if (gl_LocalInvocationIndex == 0u) fastest = 0u;
  barrier();
  float most = 0;
  for (int b = 0; b < FOURS; ++b) {
    vec4 square = vec4(0);
    for (int a = 0; a < D; ++a) square += w[a * FOURS + b] * w[a * FOURS + b];
    for (int c = 0; c < 4; ++c)
      if (4 * b + c < POINTS && (square[c] > most || square[c] != square[c])) most = square[c];
  }
  atomicMax(fastest, most != most ? 0x7fc00000u : floatBitsToUint(most));  // no number is more than any
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicMax(status[0], fastest);
}
