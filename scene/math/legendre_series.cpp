#include "scene/math/legendre_series.h"

#include <array>
#include <cmath>
#include <vector>

#include "scene/math/legendre_range.h"

namespace airlight::scene {

// L_i' = sum over k = i-1, i-3, ... of sqrt((2i+1)(2k+1)) L_k: from above, two running sums.
Eigen::VectorXd series_slope(const Eigen::VectorXd& f) {
  Eigen::VectorXd slope(f.size());
  double sums[2] = {0, 0};  // of sqrt(2i+1) f_i, even i and odd i
  for (Eigen::Index k = f.size() - 1; k >= 0; --k) {
    slope[k] = std::sqrt(2.0 * double(k) + 1) * sums[(k + 1) % 2];
    sums[k % 2] += std::sqrt(2.0 * double(k) + 1) * f[k];
  }
  return slope;
}

Eigen::VectorXd series_primitive(const Eigen::VectorXd& f) {
  Eigen::VectorXd primitive = Eigen::VectorXd::Zero(f.size() + 1);
  primitive[0] = f[0];
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    const double d = double(i);
    primitive[i + 1] += f[i] / std::sqrt((2 * d + 1) * (2 * d + 3));
    if (i > 0) primitive[i - 1] -= f[i] / std::sqrt((2 * d - 1) * (2 * d + 1));
  }
  return primitive;
}

namespace {

// sqrt(k + 1/2), and what the recurrence of P_k takes: P_{k+1} = first x P_k - second P_{k-1}.
struct Term {
  double scale, first, second;
};
constexpr int tabulated = 128;
Term term(int k) {
  const double d = k;
  return {std::sqrt(d + 0.5), (2 * d + 1) / (d + 1), d / (d + 1)};
}
const std::array<Term, tabulated>& terms() {
  static const auto all = [] {
    std::array<Term, tabulated> list;
    for (int k = 0; k < tabulated; ++k) list[std::size_t(k)] = term(k);
    return list;
  }();
  return all;
}

}  // namespace

double series_value(const Eigen::VectorXd& f, double x) {
  const auto& table = terms();
  double p = 1, before = 0, sum = 0;
  for (Eigen::Index k = 0; k < f.size(); ++k) {
    const Term t = k < tabulated ? table[std::size_t(k)] : term(int(k));
    sum += f[k] * t.scale * p;
    const double next = t.first * x * p - t.second * before;
    before = p;
    p = next;
  }
  return sum;
}

Eigen::VectorXd series_half(const Eigen::VectorXd& f, bool upper) {
  thread_local std::vector<std::array<Eigen::MatrixXd, 2>> all;
  const auto n = std::size_t(f.size());
  if (all.size() <= n) all.resize(n + 1);
  Eigen::MatrixXd& matrix = all[n][upper];
  if (matrix.size() == 0) matrix = upper ? legendre_restriction(int(n), 0, 1) : legendre_restriction(int(n), -1, 0);
  return matrix.triangularView<Eigen::Upper>() * f;
}

}  // namespace airlight::scene
