// Whether an iteration is good enough, and if not, which combination of the last few leaves the least (Anderson 1965):
// DiscreteOrdinates::solve. One invocation.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/smoke_state.glsl"
layout(std430, binding = AT_PARTS) readonly buffer Parts { double parts[]; };
uniform int groups;
uniform float tolerance;
const int sums = 3 + 2 * KEPT;

double total(int s) {
  double sum = 0;
  for (int g = 0; g < groups; ++g) sum += parts[g * sums + s];
  return sum;
}

// Shared, though one invocation decides: NVIDIA rounds its own arrays of doubles (common/private_doubles.glsl).
shared double a[KEPT * KEPT], right[KEPT];

void main() {
  if (gl_GlobalInvocationID.x != 0 || done != 0) return;
  int used = min(iteration - 1, KEPT), slot = (iteration - 2) % KEPT;
  double size = total(0), whole = total(1);
  if (iteration == 1) least = 1;
  if (iteration > 1) {
    for (int j = 0; j < used; ++j) gram[slot * KEPT + j] = gram[j * KEPT + slot] = total(3 + j);
    double moved = total(2);
    if (moved > 0) least = min(least, sqrt(gram[slot * KEPT + slot] / moved));
  }
  iterations = iteration;
  error = size == 0 ? 0 : sqrt(size / whole) / max(least, 1e-6);
  for (int j = 0; j < KEPT; ++j) shares[j] = 0;
  if (size == 0 || (iteration > 1 && error <= tolerance)) {
    done = iteration;
    return;
  }
  // gram shares = what the residual has of each; the greatest diagonal first, and what is left of the others' combinations is left out.
  uint gone = 0u;  // bit i: taken. Mesa's zink makes no pipeline with an array of bool
  int order[KEPT];
  double most = 0;
  for (int i = 0; i < used; ++i) {
    right[i] = total(3 + KEPT + i);
    for (int j = 0; j < used; ++j) a[i * KEPT + j] = gram[i * KEPT + j];
    most = max(most, a[i * KEPT + i]);
  }
  int rank = 0;
  for (; rank < used; ++rank) {
    int p = -1;
    for (int i = 0; i < used; ++i)
      if ((gone >> i & 1u) == 0u && (p < 0 || a[i * KEPT + i] > a[p * KEPT + p])) p = i;
    if (!(a[p * KEPT + p] > 1e-13 * most)) break;
    gone |= 1u << p;
    order[rank] = p;
    for (int i = 0; i < used; ++i)
      if ((gone >> i & 1u) == 0u) {
        double f = a[i * KEPT + p] / a[p * KEPT + p];
        for (int j = 0; j < used; ++j) a[i * KEPT + j] -= f * a[p * KEPT + j];
        right[i] -= f * right[p];
      }
  }
  for (int k = rank - 1; k >= 0; --k) {
    int p = order[k];
    double rest = right[p];
    for (int m = k + 1; m < rank; ++m) rest -= a[p * KEPT + order[m]] * shares[order[m]];
    shares[p] = rest / a[p * KEPT + p];
  }
}
