// Keeps solutions: E_d unchanged, or, for E_s, the series everywhere and on the three faces towards the camera (eq. 24), by polynomials
// P without a norm, in single precision. Also keeps the status of each system.
#include "legendre_fluids/paper.glsl"
layout(std430, binding = AT_DIRECT) buffer Direct { double direct[]; };
layout(std430, binding = AT_FACES) writeonly buffer Faces { float faces[]; };  // of a system: everywhere, then x, y, z
layout(std430, binding = AT_STATUS) writeonly buffer Status { vec2 status[]; };  // of a system: steps, residual
uniform int scatters;
uniform vec3 sides;  // -1 or 1

double norm(ivec3 index) { return sqrt((index.x + 0.5LF) * (index.y + 0.5LF) * (index.z + 0.5LF)); }

void main() {
  if (lane == 0) status[system] = vec2(STEPS_DONE, RESIDUAL);
  int x = base + SOLUTION_AT;
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) {
    if (scatters == 0)
      direct[system * UNKNOWNS + e] = work[x + e];
    else
      faces[system * SERIES_STRIDE + e] = float(norm(index_of(e)) * work[x + e]);
  }
  if (scatters == 0) return;
  int to = system * SERIES_STRIDE + UNKNOWNS;
  for (int a = 0; a < 3; ++a) {
    int inner = strides[a], count = UNKNOWNS / N[a];
    for (int f = lane; f < count; f += LOCAL_SIZE_X) {
      int first = f / inner * inner * N[a] + f % inner;
      double sum = 0;
      for (int k = 0; k < N[a]; ++k) {
        int e = first + k * inner;
        sum += (sides[a] < 0 && (k & 1) != 0 ? -1 : 1) * norm(index_of(e)) * work[x + e];
      }
      faces[to + f] = float(sum);
    }
    to += count;
  }
}
