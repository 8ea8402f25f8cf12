#include "methods/legendre_fluids/fluid.h"

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

double value_at(const ConfinedSpace& space, const Array& c, int component, const Vec3& x) {
  const int n = space.n();
  std::vector<double> legendre(n + 1);
  std::array<Array, 3> basis;
  for (int a = 0; a < 3; ++a) {
    if (a >= space.dimensions()) {
      basis[a] = Array::Ones(1);
      continue;
    }
    scene::legendre_values_at(n + 1, x[a], legendre.data());
    const Eigen::Map<const Array> values(legendre.data(), n + 1);
    basis[a] = a == component ? Array(space.phi().transpose() * values) : Array(values.head(n));
  }
  const TensorShape s = space.shape(component);
  double sum = 0;
  const double* at = c.data();
  for (int i = 0; i < s[0]; ++i)
    for (int j = 0; j < s[1]; ++j, at += s[2])
      sum += basis[0][i] * basis[1][j] * basis[2].dot(Eigen::Map<const Array>(at, s[2]));
  return sum;
}

}  // namespace airlight::legendre_fluids
