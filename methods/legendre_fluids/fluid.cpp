#include "methods/legendre_fluids/fluid.h"

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

// Without memory of its own: particles ask for thousands of them in a step.
double value_at(const ConfinedSpace& space, const Array& c, int component, const Vec3& x) {
  constexpr int most = 66;  // the greatest n, and two
  const int n = space.n();
  std::array<std::array<double, most>, 3> basis;
  for (int a = 0; a < 3; ++a) {
    if (a >= space.dimensions()) {
      basis[a][0] = 1;
      continue;
    }
    if (a != component) {
      scene::legendre_values_at(n, x[a], basis[a].data());
      continue;
    }
    std::array<double, most> legendre;
    scene::legendre_values_at(n + 1, x[a], legendre.data());
    // Column i - 1 of phi has the integral of L_i: two neighbours of it.
    for (int i = 1; i < n; ++i)
      basis[a][i - 1] = space.phi()(i + 1, i - 1) * legendre[i + 1] + space.phi()(i - 1, i - 1) * legendre[i - 1];
  }
  const TensorShape s = space.shape(component);
  double sum = 0;
  const double* at = c.data();
  for (int i = 0; i < s[0]; ++i) {
    double plane = 0;
    for (int j = 0; j < s[1]; ++j, at += s[2]) {
      double line = 0;
      for (int k = 0; k < s[2]; ++k) line += basis[2][k] * at[k];
      plane += basis[1][j] * line;
    }
    sum += basis[0][i] * plane;
  }
  return sum;
}

}  // namespace airlight::legendre_fluids
