// GMRES without restart, as methods/legendre_fluids/gmres.cpp: a number of steps of every system that is not done, or the solutions of
// those that are.
#include "legendre_fluids/paper.glsl"
uniform int steps, ends;
uniform double tolerance;
#define PARTS 16  // lanes of a vector
// Column k of the triangle has ROOM + 1 numbers, those of rotations are pairs.
#define triangle (base + TRIANGLE_AT)
#define rotations (base + ROTATIONS_AT)
#define rest (base + REST_AT)
#define parts (base + PARTS_AT)
#define vector(i) (base + VECTORS_AT + (i) * UNKNOWNS)

// Takes what lies along the first `count` vectors out of another one, and adds that to a column.
void take_out(int count, int next, int column) {
  for (int first = 0; first < count; first += LOCAL_SIZE_X / PARTS) {
    int i = first + lane / PARTS;
    double sum = 0;
    if (i < count)
      for (int e = lane % PARTS; e < UNKNOWNS; e += PARTS) sum += work[vector(i) + e] * work[next + e];
    partial[lane] = sum;
    barrier();
    if (lane % PARTS == 0 && i < count) {
      for (int p = 1; p < PARTS; ++p) sum += partial[lane + p];
      work[parts + i] = sum;
      work[column + i] += sum;
    }
    barrier();
  }
  together();
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) {
    double left = work[next + e];
    for (int i = 0; i < count; ++i) left -= work[parts + i] * work[vector(i) + e];
    work[next + e] = left;
  }
  together();
}

// The column joins the triangle by rotations; the right side turns with it.
void rotate(int k, int column, double left) {
  double upper = work[column];
  for (int i = 0; i < k; ++i) {
    double c = work[rotations + 2 * i], s = work[rotations + 2 * i + 1], lower = work[column + i + 1];
    work[column + i] = c * upper + s * lower;
    upper = c * lower - s * upper;
  }
  double size = sqrt(upper * upper + left * left);
  double c = size > 0 ? upper / size : 1, s = size > 0 ? left / size : 0, value = work[rest + k];
  work[column + k] = size;
  work[rotations + 2 * k] = c;
  work[rotations + 2 * k + 1] = s;
  work[rest + k] = c * value;
  work[rest + k + 1] = -s * value;
}

void step_on() {
  int k = int(STEPS_DONE), next = vector(k + 1), column = triangle + k * (ROOM + 1);
  apply(false, vector(k), next);
  for (int i = lane; i <= k; i += LOCAL_SIZE_X) work[column + i] = 0;
  together();
  for (int twice = 0; twice < 2; ++twice) take_out(k + 1, next, column);
  double left = sqrt(dot_of(next, next));
  for (int e = lane; e < UNKNOWNS && left > 0; e += LOCAL_SIZE_X) work[next + e] /= left;
  if (lane == 0) {
    rotate(k, column, left);
    double residual = !is_number(left) ? lost : left > 0 ? abs(work[rest + k + 1]) / SIZE_OF_RIGHT : 0;
    RESIDUAL = residual;
    STEPS_DONE = k + 1;
    DONE = residual <= tolerance || residual >= lost || k + 1 >= ROOM ? 1 : 0;
  }
  together();
}

void main() {
  for (int s = 0; s < steps; ++s) {
    if (DONE != 0) break;  // uniform over all lanes
    step_on();
  }
  if (ends == 0) return;
  int count = int(STEPS_DONE);
  for (int i = count - 1; i >= 0 && lane == 0; --i) {
    double sum = work[rest + i];
    for (int k = i + 1; k < count; ++k) sum -= work[triangle + k * (ROOM + 1) + i] * work[parts + k];
    work[parts + i] = sum / work[triangle + i * (ROOM + 1) + i];
  }
  together();
  for (int e = lane; e < UNKNOWNS; e += LOCAL_SIZE_X) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += work[parts + i] * work[vector(i) + e];
    work[base + SOLUTION_AT + e] = sum;
  }
}
