// Steps of y' = f(y), and of y' = A y where A is skew: y may be a velocity, a scalar, or both one after the other.
#pragma once
#include <functional>

#include "methods/legendre_fluids/confined_space.h"

namespace airlight::legendre_fluids {

Array runge_kutta_4(const Array& y, double dt, const std::function<Array(const Array&)>& rate);

// What a Krylov space makes of A: both keep the norm of y, for any dt and any size of that space.
enum class SkewFunction {
  exponential,  // exp(dt A)
  cayley,       // (1 - dt A / 2)^-1 (1 + dt A / 2)
};

struct SkewOperator {
  std::function<Array(const Array&)> apply;     // A y
  std::function<Array(const Array&)> weighted;  // M y: A is skew in y^T M y
};

struct KrylovStep {
  Array y;
  int dimensions = 0;   // of the space
  double estimate = 0;  // of its error, relative to the norm of y
};

// By Arnoldi's method, orthogonalised twice, until the estimate is at most `tolerance` or there are `most` vectors (>= 1).
KrylovStep krylov_step(const SkewOperator&, const Array& y, double dt, SkewFunction, int most, double tolerance);

}  // namespace airlight::legendre_fluids
