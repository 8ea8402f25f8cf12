// The matrix of the diffusion system times a vector of every system of a solve, or TRANSPOSED, the transposed matrix.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
uniform int from_vector, to_vector;
#include "compensated_ray_marching/diffusion_vectors.glsl"
layout(std430, binding = AT_MATRIX) readonly buffer Matrix { double matrix[]; };  // [row][column]
shared double parts[LOCAL_SIZE_X * LOCAL_SIZE_Y];

void main() {
  // x runs along rows of the matrix as they lie in memory.
  int x = int(gl_LocalInvocationID.x), y = int(gl_LocalInvocationID.y), z = int(gl_WorkGroupID.z);
#if TRANSPOSED
  int result = int(gl_WorkGroupID.x) * LOCAL_SIZE_X + x, part = y, parts_of = LOCAL_SIZE_Y;
#else
  int result = int(gl_WorkGroupID.x) * LOCAL_SIZE_Y + y, part = x, parts_of = LOCAL_SIZE_X;
#endif
  bool over = states[first_system + z].done != 0;  // uniform over all lanes
  if (over) return;
  double sum = 0;
  int from = vector_at(z, from_vector);
  if (result < unknowns)
    for (int k = part; k < unknowns; k += parts_of)
#if TRANSPOSED
      sum += matrix[k * unknowns + result] * vectors[from + k];
#else
      sum += matrix[result * unknowns + k] * vectors[from + k];
#endif
  parts[y * LOCAL_SIZE_X + x] = sum;
  barrier();
  for (int half_ = parts_of / 2; half_ > 0; half_ /= 2) {
    if (part < half_) parts[y * LOCAL_SIZE_X + x] += parts[y * LOCAL_SIZE_X + x + half_ * (TRANSPOSED != 0 ? LOCAL_SIZE_X : 1)];
    barrier();
  }
  if (part == 0 && result < unknowns) vectors[vector_at(z, to_vector) + result] = parts[y * LOCAL_SIZE_X + x];
}
