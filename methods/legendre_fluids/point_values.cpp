#include "methods/legendre_fluids/point_values.h"

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/legendre_fluids/point_values.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#ifndef AIRLIGHT_LEGENDRE_FLUIDS_POINT_VALUES_CPP_
#define AIRLIGHT_LEGENDRE_FLUIDS_POINT_VALUES_CPP_
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

const Recurrence& recurrence() {
  static const Recurrence made;
  return made;
}

}  // namespace
}  // namespace airlight::legendre_fluids
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight::legendre_fluids::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, lanes>;
using V = hn::Vec<D>;
constexpr D d;
constexpr int width = int(hn::MaxLanes(d)), vectors = lanes / width;

// Values of n functions at the points: [function][vector].
void Basis(const Recurrence& r, int n, const double* x, V* values) {
  for (int v = 0; v < vectors; ++v) {
    const V at = hn::LoadU(d, x + v * width);
    values[v] = hn::Set(d, std::sqrt(0.5));
    if (n > 1) values[vectors + v] = hn::Set(d, std::sqrt(1.5)) * at;
    for (int k = 1; k + 1 < n; ++k)
      values[(k + 1) * vectors + v] = MulSub(hn::Set(d, r.a[std::size_t(k)]) * at, values[k * vectors + v],
                                             hn::Set(d, r.b[std::size_t(k)]) * values[(k - 1) * vectors + v]);
  }
}

// Rows of `count` coefficients, R at a time: a function of z is loaded once for them, and their sums do not wait for each other.
template <int R>
HWY_INLINE void AddRows(const double* c, int count, const V* of_z, const V* of_y, V* plane) {
  V row[R][vectors];
  for (int r = 0; r < R; ++r)
    for (int v = 0; v < vectors; ++v) row[r][v] = hn::Set(d, c[r * count]) * of_z[v];
  for (int k = 1; k < count; ++k)
    for (int r = 0; r < R; ++r) {
      const V factor = hn::Set(d, c[r * count + k]);
      for (int v = 0; v < vectors; ++v) row[r][v] = MulAdd(factor, of_z[k * vectors + v], row[r][v]);
    }
  for (int r = 0; r < R; ++r)
    for (int v = 0; v < vectors; ++v) plane[v] = MulAdd(row[r][v], of_y[r * vectors + v], plane[v]);
}

// One order of sums, of products that are added without rounding in between, whatever the width: the same bits by AVX2 and AVX-512.
void SeriesValues(const scene::TensorShape& shape, const double* c, const double* x, const double* y, const double* z,
                  double* values) {
  constexpr int together = 4;
  const Recurrence& r = recurrence();
  V of_x[most * vectors], of_y[most * vectors], of_z[most * vectors];
  Basis(r, shape[0], x, of_x);
  Basis(r, shape[1], y, of_y);
  Basis(r, shape[2], z, of_z);
  V sum[vectors];
  for (int v = 0; v < vectors; ++v) sum[v] = hn::Zero(d);
  for (int i = 0; i < shape[0]; ++i) {
    V plane[vectors];
    for (int v = 0; v < vectors; ++v) plane[v] = hn::Zero(d);
    int j = 0;
    for (; j + together <= shape[1]; j += together, c += together * shape[2])
      AddRows<together>(c, shape[2], of_z, of_y + j * vectors, plane);
    if (j + 2 <= shape[1]) {
      AddRows<2>(c, shape[2], of_z, of_y + j * vectors, plane);
      j += 2, c += 2 * shape[2];
    }
    if (j < shape[1]) {
      AddRows<1>(c, shape[2], of_z, of_y + j * vectors, plane);
      c += shape[2];
    }
    for (int v = 0; v < vectors; ++v) sum[v] = MulAdd(plane[v], of_x[i * vectors + v], sum[v]);
  }
  for (int v = 0; v < vectors; ++v) hn::StoreU(sum[v], d, values + v * width);
}

}  // namespace airlight::legendre_fluids::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::legendre_fluids {

HWY_EXPORT(SeriesValues);

Lanes series_values(const scene::TensorShape& shape, const double* coefficients, const Lanes& x, const Lanes& y,
                    const Lanes& z) {
  Lanes values;
  HWY_DYNAMIC_DISPATCH(SeriesValues)(shape, coefficients, x.data(), y.data(), z.data(), values.data());
  return values;
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
#endif
