#include "scene/math/legendre.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "scene/math/dense.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/types.h"

namespace airlight::scene {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Rows = Eigen::Map<RowMajor>;
using ConstRows = Eigen::Map<const RowMajor>;

// (2r-1)!! / r!
double odd_over_all(int r) {
  double a = 1;
  for (int k = 1; k <= r; ++k) a *= (2.0 * k - 1) / k;
  return a;
}

// T_0 to T_{n-1} at the points.
Eigen::MatrixXd chebyshev_values(int n, const Eigen::VectorXd& x) {
  Eigen::MatrixXd values(x.size(), n);
  for (Eigen::Index p = 0; p < x.size(); ++p)
    for (int k = 0; k < n; ++k) values(p, k) = std::cos(k * std::acos(x[p]));
  return values;
}

}  // namespace

Eigen::MatrixXd legendre_derivative(int n) {
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i)
    for (int k = i - 1; k >= 0; k -= 2) d(k, i) = std::sqrt((2.0 * i + 1) * (2.0 * k + 1));
  return d;
}

Eigen::MatrixXd legendre_integral(int n) {
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n + 1, n);
  b(0, 0) = 1;
  for (int i = 0; i < n; ++i) {
    b(i + 1, i) = 1 / std::sqrt((2.0 * i + 1) * (2.0 * i + 3));
    if (i > 0) b(i - 1, i) = -1 / std::sqrt((2.0 * i - 1) * (2.0 * i + 1));
  }
  return b;
}

double legendre_triple(int i, int j, int k) {
  const int s = (i + j + k) / 2;
  if ((i + j + k) % 2 != 0 || std::max({i, j, k}) > s) return 0;
  const double symbol =
      odd_over_all(s - i) * odd_over_all(s - j) * odd_over_all(s - k) / ((2 * s + 1) * odd_over_all(s));
  return std::sqrt((2.0 * i + 1) * (2.0 * j + 1) * (2.0 * k + 1) / 2) * symbol;
}

Eigen::MatrixXd chebyshev_truncation(int n) {
  const int full = 2 * n - 1;
  Eigen::VectorXd root(full);
  for (int p = 0; p < full; ++p) root[p] = std::cos(pi * (p + 0.5) / full);
  // Chebyshev coefficients by the sum over roots, which is exact below degree 2 n - 1.
  Eigen::MatrixXd to_chebyshev =
      2.0 / full * product(chebyshev_values(n, root).transpose(), legendre_values(full, root));
  to_chebyshev.row(0) *= 0.5;
  const LegendrePoints& points = legendre_points(n);
  Eigen::MatrixXd truncation = product(product(points.analysis, chebyshev_values(n, points.node)), to_chebyshev);
  truncation.leftCols(n).setIdentity();  // what it is but for rounding
  return truncation;
}

void legendre_values_at(int n, double x, double* values) {
  double p = 1, before = 0;
  for (int k = 0; k < n; ++k) {
    values[k] = std::sqrt(k + 0.5) * p;
    const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
    before = p;
    p = next;
  }
}

Eigen::MatrixXd legendre_values(int n, const Eigen::VectorXd& x) {
  RowMajor values(x.size(), n);
  for (Eigen::Index p = 0; p < x.size(); ++p) legendre_values_at(n, x[p], values.data() + p * n);
  return values;
}

Eigen::MatrixXd legendre_slopes(int n, const Eigen::VectorXd& x) {
  return product(legendre_values(n, x), legendre_derivative(n));
}

LegendrePoints::LegendrePoints(int n, int m) {
  const GaussLegendre rule = gauss_legendre(m);
  node = Eigen::Map<const Eigen::VectorXd>(rule.node.data(), m);
  weight = Eigen::Map<const Eigen::VectorXd>(rule.weight.data(), m);
  values = legendre_values(n, node);
  slopes = legendre_slopes(n, node);
  analysis = values.transpose() * weight.asDiagonal();
}

const LegendrePoints& legendre_points(int n) {
  constexpr std::size_t most = 256;
  static std::array<std::once_flag, most> once;
  static std::array<std::unique_ptr<const LegendrePoints>, most> all;
  const auto i = std::size_t(n);
  std::call_once(once.at(i), [&] { all[i] = std::make_unique<const LegendrePoints>(n, n); });
  return *all[i];
}

const LegendrePoints& legendre_points(int n, int m) {
  static std::mutex mutex;
  static std::map<std::pair<int, int>, LegendrePoints> all;
  const std::lock_guard lock(mutex);
  return all.try_emplace({n, m}, n, m).first->second;
}

Eigen::VectorXd along_axis(int axis, const Eigen::MatrixXd& matrix, const Eigen::VectorXd& array,
                           const TensorShape& shape) {
  Eigen::Index outer = 1, inner = 1;
  for (int a = 0; a < axis; ++a) outer *= shape[std::size_t(a)];
  for (int a = axis + 1; a < 3; ++a) inner *= shape[std::size_t(a)];
  const Eigen::Index from = matrix.cols(), to = matrix.rows();
  Eigen::VectorXd result(outer * to * inner);
  if (inner == 1) {
    Rows(result.data(), outer, to).noalias() = ConstRows(array.data(), outer, from) * matrix.transpose();
    return result;
  }
  for (Eigen::Index o = 0; o < outer; ++o)
    Rows(result.data() + o * to * inner, to, inner).noalias() =
        matrix * ConstRows(array.data() + o * from * inner, from, inner);
  return result;
}

Eigen::VectorXd along_axes(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const Eigen::MatrixXd& z,
                           const Eigen::VectorXd& array, const TensorShape& shape) {
  const int nx = int(x.rows()), ny = int(y.rows());
  return along_axis(2, z, along_axis(1, y, along_axis(0, x, array, shape), {nx, shape[1], shape[2]}),
                    {nx, ny, shape[2]});
}

Eigen::VectorXd legendre_product(const Eigen::VectorXd& f, const TensorShape& f_shape, const Eigen::VectorXd& g,
                                 const TensorShape& g_shape, const TensorShape& kept, int dimensions) {
  std::array<Eigen::MatrixXd, 3> f_values, g_values, analysis;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    f_values[axis] = g_values[axis] = analysis[axis] = Eigen::MatrixXd::Ones(1, 1);
    if (int(axis) >= dimensions) continue;
    // The integrand of a coefficient has degree f + g + kept - 3.
    const int m = (f_shape[axis] + g_shape[axis] + kept[axis] - 1) / 2;
    const LegendrePoints& points = legendre_points(kept[axis], m);
    f_values[axis] = legendre_values(f_shape[axis], points.node);
    g_values[axis] = legendre_values(g_shape[axis], points.node);
    analysis[axis] = points.analysis;
  }
  const Eigen::VectorXd product = along_axes(f_values[0], f_values[1], f_values[2], f, f_shape)
                                      .cwiseProduct(along_axes(g_values[0], g_values[1], g_values[2], g, g_shape));
  const TensorShape points = {int(f_values[0].rows()), int(f_values[1].rows()), int(f_values[2].rows())};
  return along_axes(analysis[0], analysis[1], analysis[2], product, points);
}

}  // namespace airlight::scene
