// A velocity for tests of Legendre fluids, and how far arrays are apart.
#pragma once
#include <random>

#include "methods/legendre_fluids/confined_space.h"

namespace airlight::legendre_fluids::testing {

// The greatest difference over the greatest entry expected.
inline double error(const Array& got, const Array& expected) {
  if (got.size() != expected.size()) return infinity;
  return (got - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

// Smooth and confined, without divergence, |u| at most 1: low modes, the same for every n.
inline Array swirl(const ConfinedSpace& space, unsigned seed = 1) {
  const auto component = [&](int a, const Vec3& x) {
    std::mt19937 random(seed + 17 * unsigned(a));
    std::normal_distribution<double> normal;
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < (space.dimensions() == 3 ? 3 : 1); ++k)
          sum += normal(random) * std::pow(x[0], i) * std::pow(x[1], j) * (k ? std::pow(x[2], k) : 1);
    return (1 - x[a] * x[a]) * sum;
  };
  const Array u = space.project(space.from_function([&](const Vec3& x) {
    Vec3 v = Vec3::Zero();
    for (int a = 0; a < space.dimensions(); ++a) v[a] = component(a, x);
    return v;
  }));
  const Components values = space.at_points(u);
  Array speed = Array::Zero(values[0].size());
  for (int a = 0; a < space.dimensions(); ++a) speed += values[a].cwiseAbs2();
  return u / std::sqrt(speed.maxCoeff());
}

}  // namespace airlight::legendre_fluids::testing
