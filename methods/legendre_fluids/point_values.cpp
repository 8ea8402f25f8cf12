#include "methods/legendre_fluids/point_values.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace airlight::legendre_fluids {
namespace {

constexpr int most = 96;

// L_{k+1} = (a_k x L_k - b_k L_{k-1}), the orthonormal ones.
struct Recurrence {
  std::array<double, most> a, b;
  Recurrence() {
    for (int k = 0; k < most; ++k) {
      const double next = std::sqrt((2.0 * k + 3) / (2.0 * k + 1));
      a[std::size_t(k)] = (2.0 * k + 1) / (k + 1) * next;
      b[std::size_t(k)] = k == 0 ? 0 : k / (k + 1.0) * next * std::sqrt((2.0 * k + 1) / (2.0 * k - 1));
    }
  }
};

void basis(int n, const Lanes& x, Lanes* values) {
  static const Recurrence recurrence;
  values[0] = std::sqrt(0.5);
  if (n > 1) values[1] = std::sqrt(1.5) * x;
  for (int k = 1; k + 1 < n; ++k)
    values[k + 1] = recurrence.a[std::size_t(k)] * x * values[k] - recurrence.b[std::size_t(k)] * values[k - 1];
}

}  // namespace

Lanes series_values(const scene::TensorShape& shape, const double* coefficients, const Lanes& x, const Lanes& y,
                    const Lanes& z) {
  std::array<Lanes, most> of_x, of_y, of_z;
  basis(shape[0], x, of_x.data());
  basis(shape[1], y, of_y.data());
  basis(shape[2], z, of_z.data());
  const double* c = coefficients;
  Lanes sum = Lanes::Zero();
  for (int i = 0; i < shape[0]; ++i) {
    Lanes plane = Lanes::Zero();
    for (int j = 0; j < shape[1]; ++j) {
      Lanes row = *c++ * of_z[0];
      for (int k = 1; k < shape[2]; ++k) row += *c++ * of_z[std::size_t(k)];
      plane += row * of_y[std::size_t(j)];
    }
    sum += plane * of_x[std::size_t(i)];
  }
  return sum;
}

Eigen::VectorXd series_values(const scene::TensorShape& shape, const double* coefficients,
                              const std::vector<Vec3>& points) {
  Eigen::VectorXd values(Eigen::Index(points.size()));
  for (std::size_t begin = 0; begin < points.size(); begin += lanes) {
    const std::size_t here = std::min<std::size_t>(lanes, points.size() - begin);
    std::array<Lanes, 3> x;
    for (std::size_t i = 0; i < lanes; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        x[a][Eigen::Index(i)] = points[begin + std::min(i, here - 1)][Eigen::Index(a)];
    const Lanes all = series_values(shape, coefficients, x[0], x[1], x[2]);
    values.segment(Eigen::Index(begin), Eigen::Index(here)) = all.head(Eigen::Index(here));
  }
  return values;
}

double series_value(const scene::TensorShape& shape, const double* coefficients, const Vec3& at) {
  std::array<double, most> x, y, z;
  scene::legendre_values_at(shape[0], at[0], x.data());
  scene::legendre_values_at(shape[1], at[1], y.data());
  scene::legendre_values_at(shape[2], at[2], z.data());
  double sum = 0;
  for (int i = 0; i < shape[0]; ++i)
    for (int j = 0; j < shape[1]; ++j) {
      double row = 0;
      for (int k = 0; k < shape[2]; ++k) row += *coefficients++ * z[std::size_t(k)];
      sum += row * x[std::size_t(i)] * y[std::size_t(j)];
    }
  return sum;
}

}  // namespace airlight::legendre_fluids
