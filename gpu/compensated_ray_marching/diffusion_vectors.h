// Vectors and state of diffusion systems as diffusion_vectors.glsl has them.
#pragma once

namespace airlight::gpu::compensated_ray_marching {

namespace diffusion {
// A system has vectors [vector][unknown] of doubles. Conjugate gradients of a symmetric matrix need no gradient.
enum Vector {
  right,
  solution,
  residual,
  direction,
  along,
  gradient,
  vectors_of_least_squares,
  vectors_of_gradients = gradient
};

struct SystemData {
  double square, whole, alpha, beta, diagonal, left;
  int done, iterations, negative, unused;
};
}  // namespace diffusion

}  // namespace airlight::gpu::compensated_ray_marching
