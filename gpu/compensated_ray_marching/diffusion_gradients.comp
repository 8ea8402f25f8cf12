// Conjugate gradients on the normal equations, or LSQR, between products with the matrix: conjugate_gradients and lsqr of
// diffusion_system.cpp, with their iterations and their end. A system is a work group's.
layout(local_size_x = LOCAL_SIZE_X) in;
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
  for (int i = lane; i < unknowns; i += lanes) sum += vectors[vector + i] * vectors[vector + i];
  return total(sum);
}

#if LSQR
// Vector `to` becomes `from` less `factor` times what it was, of length 1 unless it is 0. Returns the length before.
double normalised(int to, int from, double factor) {
  for (int i = lane; i < unknowns; i += lanes) vectors[to + i] = vectors[from + i] - factor * vectors[to + i];
  double length_ = sqrt(square_of(to));
  if (length_ > 0)
    for (int i = lane; i < unknowns; i += lanes) vectors[to + i] /= length_;
  return length_;
}
#endif

void main() {
  int z = int(gl_WorkGroupID.z), system = first_system + z;
  int right = vector_at(z, RIGHT), solution = vector_at(z, SOLUTION), residual = vector_at(z, RESIDUAL), gradient = vector_at(z, GRADIENT),
      direction = vector_at(z, DIRECTION), along = vector_at(z, ALONG);
  if (stage == STAGE_SPREAD) {  // the solution of the solve's first system, to all
    int first = vector_at(0, SOLUTION);
    if (z > 0)
      for (int i = lane; i < unknowns; i += lanes) vectors[solution + i] = vectors[first + i];
    return;
  }
  if (stage == STAGE_RESIDUAL) {  // `along` is the matrix times the start
    for (int i = lane; i < unknowns; i += lanes) vectors[residual + i] = vectors[right + i] - vectors[along + i];
    return;
  }
  if (states[system].done != 0) return;
  State now = states[system];
#if LSQR
  if (stage == STAGE_STEP) {
    now.beta = normalised(residual, along, now.alpha);
    if (lane == 0) states[system].beta = now.beta;
    return;
  }
  double share;  // of the direction before
  if (stage == STAGE_BEGIN) {  // the gradient is the transposed matrix times the start's residual, not of length 1
    now.whole = sqrt(square_of(along));
    now.left = normalised(residual, residual, 0);
    now.alpha = now.left > 0 ? normalised(gradient, gradient, 0) / now.left : 0;
    now.diagonal = now.alpha;
    now.square = now.alpha * now.left;
    now.iterations = 0;
    share = 0;
  } else {
    now.alpha = normalised(gradient, along, now.beta);
    double length_ = sqrt(now.diagonal * now.diagonal + now.beta * now.beta);
    double cosine = now.diagonal / length_, sine = now.beta / length_, step_ = cosine * now.left / length_;
    for (int i = lane; i < unknowns; i += lanes) vectors[solution + i] += step_ * vectors[direction + i];
    share = -sine * now.alpha / length_;
    now.left *= sine;
    now.diagonal = -cosine * now.alpha;
    now.square = now.left * now.alpha * abs(cosine);
    ++now.iterations;
  }
  now.square *= now.square;
#else
  if (stage == STAGE_STEP) {
    double length_ = square_of(along);
    if (length_ > 0) {
      double step_ = now.square / length_;
      for (int i = lane; i < unknowns; i += lanes) {
        vectors[solution + i] += step_ * vectors[direction + i];
        vectors[residual + i] -= step_ * vectors[along + i];
      }
    } else if (lane == 0) {
      states[system].done = 1;
    }
    return;
  }
  // The gradient is new: of the first iteration, where `along` is the transposed matrix times the right side, or of the next.
  double next = square_of(gradient), share = 0;
  if (stage == STAGE_BEGIN) {
    now.whole = sqrt(square_of(along));
    now.iterations = 0;
  } else {
    share = next / now.square;
    ++now.iterations;
  }
  now.square = next;
#endif
  if (!(now.whole > 0)) now.whole = 1;
  double negative = 0;
  for (int i = lane; i < unknowns; i += lanes) {
    vectors[direction + i] = vectors[gradient + i] + (share == 0 ? 0 : share * vectors[direction + i]);
    if (vectors[solution + i] < 0) negative += 1;
  }
  now.negative = int(total(negative));
  now.done = now.iterations < most_iterations && sqrt(now.square) > tolerance * now.whole ? 0 : 1;
  if (lane == 0) states[system] = now;
}
