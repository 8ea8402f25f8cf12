#include "scene/math/gauss_legendre.h"

#include <cmath>

#include "scene/math/types.h"

namespace airlight::scene {

GaussLegendre gauss_legendre(int n) {
  GaussLegendre rule{std::vector<double>(n), std::vector<double>(n)};
  for (int i = 0; i < (n + 1) / 2; ++i) {
    double x = 2 * i + 1 == n ? 0 : std::cos(pi * (i + 0.75) / (n + 0.5));  // within O(n^-4) of the root
    double slope = 0;
    for (int step = 0; step < 5; ++step) {  // Newton doubles the digits
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1);
      if (2 * i + 1 != n) x -= p / slope;
    }
    rule.node[i] = -x;
    rule.node[n - 1 - i] = x;
    rule.weight[i] = rule.weight[n - 1 - i] = 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace airlight::scene
