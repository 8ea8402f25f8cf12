// Where a solve by discrete ordinates stands. `done`: the iteration that was good enough, 0 while none was.
layout(std430, binding = AT_STATE) buffer State {
  double error, least;  // estimated; by how much of its own size a part of the error shows in the residual
  double gram[KEPT * KEPT], shares[KEPT];
  int done, iterations;
};
uniform int iteration;  // from 1
bool is_over() { return done != 0 && done != iteration; }
