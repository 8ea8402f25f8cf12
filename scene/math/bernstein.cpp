#include "scene/math/bernstein.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "scene/math/dense.h"
#include "scene/math/types.h"

namespace airlight {
namespace {

using Matrix = Eigen::Matrix<double, bernstein_size, bernstein_size>;

Matrix values_to_coefficients() {
  Matrix basis;
  for (int row = 0; row < bernstein_size; ++row) {
    const double s = bernstein_nodes()[row];
    double binomial = 1;
    for (int k = 0; k < bernstein_size; ++k) {
      basis(row, k) = binomial * std::pow(s, k) * std::pow(1 - s, bernstein_size - 1 - k);
      binomial *= double(bernstein_size - 1 - k) / (k + 1);
    }
  }
  return scene::inverse(basis);
}

// `length` is that of the piece which p stands for, as a share of the whole.
double positive_part(const Bernstein& p, double length, double tolerance) {
  const auto [least, greatest] = std::minmax_element(p.begin(), p.end());
  if (*greatest <= 0) return 0;
  double sum = 0;
  for (double c : p) sum += c;
  const double integral = length * sum / bernstein_size;
  if (*least >= 0) return integral;
  if (length * std::max(*greatest, -*least) <= tolerance * std::sqrt(length)) return std::max(0.0, integral);
  // de Casteljau at the middle.
  Bernstein left, right = p;
  for (int k = 0; k < bernstein_size; ++k) {
    left[k] = right[0];
    for (int i = 0; i + 1 < bernstein_size - k; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
  }
  return positive_part(left, 0.5 * length, tolerance) + positive_part(right, 0.5 * length, tolerance);
}

}  // namespace

const Bernstein& bernstein_nodes() {
  static const Bernstein nodes = [] {
    Bernstein s;
    for (int k = 0; k < bernstein_size; ++k) s[k] = 0.5 - 0.5 * std::cos(pi * (k + 0.5) / bernstein_size);
    return s;
  }();
  return nodes;
}

Bernstein bernstein_through(const Bernstein& values) {
  static const Matrix matrix = values_to_coefficients();
  Bernstein coefficients;
  Eigen::Map<Eigen::Vector<double, bernstein_size>>(coefficients.data()) =
      matrix * Eigen::Map<const Eigen::Vector<double, bernstein_size>>(values.data());
  return coefficients;
}

double integral_of_positive_part(const Bernstein& p, double tolerance) { return positive_part(p, 1, tolerance); }

}  // namespace airlight
