// Vectors and state of the diffusion systems, one for each light; those of a solve have their matrix in common.
layout(std430, binding = AT_VECTORS) buffer Vectors { double vectors[]; };  // [system][vector][centre]
uniform int first_system;
#define RIGHT 0
#define SOLUTION 1
#define RESIDUAL 2   // right side less matrix times solution; of LSQR u
#define GRADIENT 3   // transposed matrix times the residual; of LSQR v
#define DIRECTION 4
#define ALONG 5      // matrix times direction; of LSQR times v, then transposed times u
int vector_at(int system, int vector) { return ((first_system + system) * 6 + vector) * gaussian_count; }

struct State {
  double square, whole;  // |gradient|^2, and what its root is relative to
  double alpha, beta, diagonal, left;  // of LSQR alone
  int done, iterations, negative, unused;
};
layout(std430, binding = AT_SYSTEMS) buffer Systems { State states[]; };
