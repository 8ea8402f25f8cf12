#include "methods/legendre_fluids/time_steps.h"

#include <cmath>
#include <complex>
#include <vector>

#include "scene/math/dense.h"

namespace airlight::legendre_fluids {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;

Array runge_kutta_4(const Array& y, double dt, const std::function<Array(const Array&)>& rate) {
  const Array k1 = rate(y), k2 = rate(y + 0.5 * dt * k1), k3 = rate(y + 0.5 * dt * k2), k4 = rate(y + dt * k3);
  return y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

namespace {

// The first column of f(dt H) for a skew H, by its imaginary eigenvalues: a column of a unitary matrix.
Array first_column(const MatrixXd& h, double dt, SkewFunction function) {
  const std::complex<double> i(0, 1);
  const MatrixXd skew = 0.5 * (h - h.transpose());
  const scene::HermitianModes modes = scene::hermitian_modes(-i * skew.cast<std::complex<double>>());
  Eigen::VectorXcd weights = modes.vectors.row(0).adjoint();
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    const double angle = dt * modes.values[k];
    weights[k] *=
        function == SkewFunction::exponential ? std::exp(i * angle) : (1.0 + 0.5 * i * angle) / (1.0 - 0.5 * i * angle);
  }
  return (modes.vectors * weights).real();
}

}  // namespace

KrylovStep krylov_step(const SkewOperator& a, const Array& y, double dt, SkewFunction function, int most,
                       double tolerance) {
  const double norm = y.size() ? std::sqrt(std::max(0.0, y.dot(a.weighted(y)))) : 0;
  if (norm == 0) return {y, 0, 0};
  std::vector<Array> basis{y / norm}, dual{a.weighted(basis[0])};
  MatrixXd h = MatrixXd::Zero(most + 1, most + 1);
  KrylovStep step;
  Array column;
  for (int m = 1; m <= most; ++m) {
    Array next = a.apply(basis.back());
    const double before = std::sqrt(std::max(0.0, next.dot(a.weighted(next))));
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < m; ++j) {
        const double share = dual[j].dot(next);
        h(j, m - 1) += share;
        next -= share * basis[j];
      }
    const Array heavy = a.weighted(next);
    const double rest = std::sqrt(std::max(0.0, next.dot(heavy)));
    column = first_column(h.topLeftCorner(m, m), dt, function);
    step.dimensions = m;
    // What leaves the space over the step; nothing where the space is invariant.
    const bool invariant = rest <= 1e-14 * std::max(before, 1e-300);
    step.estimate = invariant ? 0 : std::abs(dt * rest * column[m - 1]);
    if (step.estimate <= tolerance || m == most) break;
    h(m, m - 1) = rest;
    basis.push_back(next / rest);
    dual.push_back(heavy / rest);
  }
  step.y = Array::Zero(y.size());
  for (int j = 0; j < step.dimensions; ++j) step.y += norm * column[j] * basis[j];
  return step;
}

}  // namespace airlight::legendre_fluids
