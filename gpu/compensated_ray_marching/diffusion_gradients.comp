// Conjugate gradients on the normal equations between products with the matrix: conjugate_gradients of diffusion_system.cpp, with its
// iterations and its end. A system is a work group's.
layout(local_size_x = LOCAL_SIZE_X) in;
uniform int gaussian_count;
#include "compensated_ray_marching/diffusion_vectors.glsl"
#define lane int(gl_LocalInvocationIndex)
const int lanes = LOCAL_SIZE_X;
uniform int stage;  // a GradientStage
uniform int most_iterations;
uniform double tolerance;
shared double parts[lanes];

double total(double mine) {
  barrier();
  parts[lane] = mine;
  barrier();
  for (int half_ = lanes / 2; half_ > 0; half_ /= 2) {
    if (lane < half_) parts[lane] += parts[lane + half_];
    barrier();
  }
  return parts[0];
}
double square_of(int vector) {
  double sum = 0;
  for (int i = lane; i < gaussian_count; i += lanes) sum += vectors[vector + i] * vectors[vector + i];
  return total(sum);
}

void main() {
  int z = int(gl_WorkGroupID.z), system = first_system + z;
  int right = vector_at(z, RIGHT), solution = vector_at(z, SOLUTION), missed = vector_at(z, MISSED), slope = vector_at(z, SLOPE),
      direction = vector_at(z, DIRECTION), along = vector_at(z, ALONG);
  if (stage == STAGE_SPREAD) {  // the solution of the solve's first system, to all
    int first = vector_at(0, SOLUTION);
    if (z > 0)
      for (int i = lane; i < gaussian_count; i += lanes) vectors[solution + i] = vectors[first + i];
    return;
  }
  if (stage == STAGE_MISS) {  // `along` is the matrix times the start
    for (int i = lane; i < gaussian_count; i += lanes) vectors[missed + i] = vectors[right + i] - vectors[along + i];
    return;
  }
  if (states[system].done != 0) return;
  double square = states[system].square;
  if (stage == STAGE_STEP) {
    double length_ = square_of(along);
    if (length_ > 0) {
      double step_ = square / length_;
      for (int i = lane; i < gaussian_count; i += lanes) {
        vectors[solution + i] += step_ * vectors[direction + i];
        vectors[missed + i] -= step_ * vectors[along + i];
      }
    } else if (lane == 0) {
      states[system].done = 1;
    }
    return;
  }
  // The slope is new: of the first iteration, where `along` is the transposed matrix times the right side, or of the next.
  double next = square_of(slope), share = 0, whole = states[system].whole, negative = 0;
  int iterations = 0;
  if (stage == STAGE_BEGIN) {
    whole = sqrt(square_of(along));
    if (!(whole > 0)) whole = 1;
  } else {
    share = next / square;
    iterations = states[system].iterations + 1;
  }
  for (int i = lane; i < gaussian_count; i += lanes) {
    vectors[direction + i] = vectors[slope + i] + (share == 0 ? 0 : share * vectors[direction + i]);
    if (vectors[solution + i] < 0) negative += 1;
  }
  negative = total(negative);
  bool goes_on = iterations < most_iterations && sqrt(next) > tolerance * whole;
  if (lane == 0) states[system] = State(next, whole, goes_on ? 0 : 1, iterations, int(negative), 0);
}
