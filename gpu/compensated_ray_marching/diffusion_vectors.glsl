// Vectors and state of diffusion systems, one for each light; those of a solve have their matrix in common. Host: diffusion_vectors.h.
layout(std430, binding = AT_VECTORS) buffer Vectors { double vectors[]; };  // [system][vector][unknown]
uniform int first_system, unknowns;  // unknowns: centres of Gaussians, or cells of a grid
#define RIGHT 0
#define SOLUTION 1
#define RESIDUAL 2   // right side less matrix times solution; of LSQR u
#define DIRECTION 3
#define ALONG 4      // matrix times direction; of LSQR times v, then transposed times u
#define GRADIENT 5   // of least squares alone: transposed matrix times the residual; of LSQR v
int vector_at(int system, int vector) { return ((first_system + system) * VECTORS + vector) * unknowns; }

struct State {
  double square, whole;  // |gradient|^2, without least squares |residual|^2; what its root is relative to
  double alpha, beta, diagonal, left;  // of LSQR alone
  int done, iterations, negative, unused;
};
layout(std430, binding = AT_SYSTEMS) buffer Systems { State states[]; };
