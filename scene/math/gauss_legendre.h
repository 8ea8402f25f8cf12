// Gauss-Legendre quadrature with any number of points.
#pragma once
#include <vector>

namespace airlight::scene {

// Integral of f over [-1, 1] ~ sum weight[i] f(node[i]); exact for polynomials of degree 2 n - 1. Nodes ascend.
struct GaussLegendre {
  std::vector<double> node;
  std::vector<double> weight;
};

GaussLegendre gauss_legendre(int n);  // n >= 1; errors about 1e-15

}  // namespace airlight::scene
