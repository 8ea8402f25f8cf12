#include "scene/math/bspline.h"

#include <cmath>

namespace airlight::scene {

double bspline(int n, double u) {
  if (!(u >= 0) || !(u < n + 1)) return 0;
  const int cell = int(std::floor(u));
  return with_degree(n, [&](auto degree) {
    double value[degree() + 1];
    cell_basis<degree()>(u - cell, value);
    return value[cell];
  });
}

// By the recursion of de Boor.
double bspline_at_integer(int m, int k) {
  if (m == 0) return k == 0;
  if (k <= 0 || k > m) return 0;
  return (k * bspline_at_integer(m - 1, k) + (m + 1 - k) * bspline_at_integer(m - 1, k - 1)) / m;
}

}  // namespace airlight::scene
