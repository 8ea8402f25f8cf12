#include "methods/wavelet_fog/projection.h"

#include <Eigen/Core>
#include <cmath>

#include "scene/math/bspline.h"
#include "scene/math/dense.h"

namespace airlight::wavelet_fog {
namespace {

// Inner product of two splines of degree n, d apart: N_{2n+1}(n + 1 + d).
double inner_product(int n, int d) { return scene::bspline_at_integer(2 * n + 1, n + 1 + std::abs(d)); }

}  // namespace

Coefficients orthogonal_projection(const Coefficients& c, int degree) {
  const Taps p = two_scale(degree);
  const int lo = c.range.lo[0], size = c.range.size[0], width = degree + 1;
  // Coarse spline k lies over [2k, 2k + 2 (n + 1)] of the fine index, the fine ones over [lo, lo + size + n].
  const int first = int(std::floor((lo - 2 * width) / 2.0)) + 1, last = int(std::ceil((lo + size + degree) / 2.0)) - 1;
  const int count = last - first + 1;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count), onto = Eigen::MatrixXd::Zero(count, size);
  const int taps = int(p.values.size());
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b)
      for (int s = 0; s < taps; ++s)
        for (int t = 0; t < taps; ++t)
          gram(a, b) += p.values[s] * p.values[t] * inner_product(degree, 2 * (a - b) + s - t);
    for (int i = 0; i < size; ++i)
      for (int s = 0; s < taps; ++s) onto(a, i) += p.values[s] * inner_product(degree, 2 * (first + a) + s - (lo + i));
  }
  const Eigen::MatrixXd projection = scene::solve_definite(gram, onto);
  Coefficients out{{{first, c.range.lo[1]}, {count, c.range.size[1]}}, {}};
  for (int j = 0; j < c.range.size[1]; ++j) {
    const Eigen::Map<const Eigen::VectorXd> row(c.values.data() + std::size_t(j) * size, size);
    const Eigen::VectorXd coarse = projection * row;
    out.values.insert(out.values.end(), coarse.data(), coarse.data() + count);
  }
  return out;
}

}  // namespace airlight::wavelet_fog
