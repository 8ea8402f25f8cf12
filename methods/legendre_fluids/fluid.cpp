#include "methods/legendre_fluids/fluid.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace airlight::legendre_fluids {

std::vector<Array*> Fluid::carried() {
  std::vector<Array*> all{&density};
  for (Array& r : others) all.push_back(&r);
  all.push_back(&temperature);
  return all;
}

double Fluid::energy() const {
  const Components u = at_points();
  Array squares = Array::Zero(u[0].size());
  for (int a = 0; a < space_.dimensions(); ++a) squares += space_.half()[a] * space_.half()[a] * u[a].cwiseAbs2();
  return 0.5 * space_.integral(squares);
}

double Fluid::greatest_speed() const {
  const Components u = at_points();
  Array squares = u[0].cwiseAbs2();
  for (int a = 1; a < space_.dimensions(); ++a) squares += u[a].cwiseAbs2();
  return std::sqrt(squares.maxCoeff());
}

namespace {

constexpr int most = 66;  // the greatest n, and two
using Basis = std::array<double, most>;

// L_{k+1} = a_k x L_k - b_k L_{k-1}, the orthonormal ones.
struct Recurrence {
  Basis a, b;
  Recurrence() {
    for (int k = 0; k < most; ++k) {
      const double next = std::sqrt((2.0 * k + 3) / (2.0 * k + 1));
      a[k] = (2.0 * k + 1) / (k + 1) * next;
      b[k] = k == 0 ? 0 : k / (k + 1.0) * next * std::sqrt((2.0 * k + 1) / (2.0 * k - 1));
    }
  }
};

void legendre_basis(int n, double x, Basis& values) {
  static const Recurrence recurrence;
  values[0] = std::sqrt(0.5);
  values[1] = std::sqrt(1.5) * x;
  for (int k = 1; k + 1 < n; ++k) values[k + 1] = recurrence.a[k] * x * values[k] - recurrence.b[k] * values[k - 1];
}

}  // namespace

// Without memory of its own, and the last axis summed last: particles ask for thousands of them in a step.
Array Fluid::at(int component, const std::vector<Vec3>& x) const {
  Array values(Eigen::Index(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) values[Eigen::Index(i)] = at(component, x[i]);
  return values;
}

double value_at(const ConfinedSpace& space, const Array& c, int component, const Vec3& x) {
  const int n = space.n();
  std::array<Basis, 3> basis;
  for (int a = 0; a < 3; ++a) {
    if (a >= space.dimensions()) {
      basis[a][0] = 1;
      continue;
    }
    if (a != component) {
      legendre_basis(n, x[a], basis[a]);
      continue;
    }
    Basis legendre;
    legendre_basis(n + 1, x[a], legendre);
    // Column i - 1 of phi has the integral of L_i: two neighbours of it.
    for (int i = 1; i < n; ++i)
      basis[a][i - 1] = space.phi()(i + 1, i - 1) * legendre[i + 1] + space.phi()(i - 1, i - 1) * legendre[i - 1];
  }
  const TensorShape s = space.shape(component);
  Basis line;
  std::fill_n(line.begin(), s[2], 0.0);
  const double* at = c.data();
  for (int i = 0; i < s[0]; ++i)
    for (int j = 0; j < s[1]; ++j, at += s[2]) {
      const double weight = basis[0][i] * basis[1][j];
      for (int k = 0; k < s[2]; ++k) line[k] += weight * at[k];
    }
  double sum = 0;
  for (int k = 0; k < s[2]; ++k) sum += basis[2][k] * line[k];
  return sum;
}

}  // namespace airlight::legendre_fluids
