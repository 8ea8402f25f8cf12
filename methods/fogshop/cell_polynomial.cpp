#include "methods/fogshop/cell_polynomial.h"

#include <cmath>

namespace airlight::fogshop {
namespace {

constexpr int degree = CellPolynomial::degree, nodes = degree + 1;

double chebyshev_node(int i) { return std::cos(pi * (i + 0.5) / nodes); }

// [coefficient][point]: transforms along three axes, and from Chebyshev's polynomials to powers.
using Fit = Eigen::Matrix<double, CellPolynomial::size, CellPolynomial::points>;

Fit make_fit() {
  double power[nodes][nodes] = {};  // of T_k the coefficient of x^i
  power[0][0] = power[1][1] = 1;
  for (int k = 2; k < nodes; ++k)
    for (int i = 0; i < nodes; ++i) power[k][i] = (i > 0 ? 2 * power[k - 1][i - 1] : 0) - power[k - 2][i];
  double transform[nodes][nodes];  // to the coefficient of T_k from the value at node i
  for (int k = 0; k < nodes; ++k)
    for (int i = 0; i < nodes; ++i)
      transform[k][i] = (k == 0 ? 1.0 : 2.0) / nodes * std::cos(k * pi * (i + 0.5) / nodes);
  Fit fit = Fit::Zero();
  for (int k = 0; k <= degree; ++k)
    for (int l = 0; k + l <= degree; ++l)
      for (int m = 0; k + l + m <= degree; ++m) {
        int row = 0;
        for (int a = 0; a <= degree; ++a)
          for (int b = 0; a + b <= degree; ++b)
            for (int c = 0; a + b + c <= degree; ++c, ++row) {
              const double factor = power[k][a] * power[l][b] * power[m][c];
              if (factor == 0) continue;
              for (int p = 0; p < CellPolynomial::points; ++p)
                fit(row, p) += factor * transform[k][p % nodes] * transform[l][p / nodes % nodes] *
                               transform[m][p / (nodes * nodes)];
            }
      }
  return fit;
}

}  // namespace

double CellPolynomial::operator()(const Vec3& place) const {
  double value = 0;
  for (int a = degree, k = size; a >= 0; --a) {
    double along_x = 0;
    for (int b = degree - a; b >= 0; --b) {
      double along_y = 0;
      for (int c = degree - a - b; c >= 0; --c) along_y = along_y * place.z() + coefficients[--k];
      along_x = along_x * place.y() + along_y;
    }
    value = value * place.x() + along_x;
  }
  return value;
}

const std::vector<Vec3>& cell_points() {
  static const std::vector<Vec3> points = [] {
    std::vector<Vec3> result;
    for (int p = 0; p < CellPolynomial::points; ++p)
      result.emplace_back(chebyshev_node(p % nodes), chebyshev_node(p / nodes % nodes),
                          chebyshev_node(p / (nodes * nodes)));
    return result;
  }();
  return points;
}

CellPolynomial fit_cell(const std::vector<double>& values) {
  static const Fit fit = make_fit();
  CellPolynomial result;
  Eigen::Map<Eigen::Matrix<double, CellPolynomial::size, 1>>(result.coefficients.data()) =
      fit * Eigen::Map<const Eigen::Matrix<double, CellPolynomial::points, 1>>(values.data());
  return result;
}

}  // namespace airlight::fogshop
