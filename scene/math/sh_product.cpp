#include "scene/math/sh_product.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <mutex>

#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::scene {
namespace {

constexpr int greatest_product_order = 12;

// Integrals over azimuth of three of the functions 1, cos(m phi), sin(|m| phi). The trapezoidal rule is exact.
class Azimuth {
 public:
  explicit Azimuth(int order) : side_(2 * order - 1), reach_(order - 1), values_(side_ * side_ * side_, 0.0) {
    const int points = 4 * order;
    for (int p = 0; p < points; ++p) {
      const double phi = 2 * pi * p / points;
      std::vector<double> f(side_);
      for (int m = -reach_; m <= reach_; ++m) f[m + reach_] = m < 0 ? std::sin(-m * phi) : std::cos(m * phi);
      for (int a = 0; a < side_; ++a)
        for (int b = 0; b < side_; ++b)
          for (int c = 0; c < side_; ++c) values_[(a * side_ + b) * side_ + c] += 2 * pi / points * f[a] * f[b] * f[c];
    }
  }
  double operator()(int m1, int m2, int m3) const {
    return values_[((m1 + reach_) * side_ + m2 + reach_) * side_ + m3 + reach_];
  }

 private:
  int side_, reach_;
  std::vector<double> values_;
};

struct Index {
  int l, m;
};

}  // namespace

TripleProduct::TripleProduct(int order) : order_(order) {
  if (order < 1 || order > greatest_product_order)
    throw Error(fmt::format("products of harmonics of order {}, expected 1 to {}", order, greatest_product_order));
  // The parts that depend on theta, at the nodes of a rule for polynomials of degree 3 (order - 1).
  const int nodes = (3 * order) / 2 + 1, size = order * order;
  const GaussLegendre rule = gauss_legendre(nodes);
  std::vector<Index> index;
  for (int l = 0; l < order; ++l)
    for (int m = -l; m <= l; ++m) index.push_back({l, m});
  std::vector<std::vector<double>> polar(size, std::vector<double>(nodes));
  for (int n = 0; n < nodes; ++n) {
    const double z = rule.node[n];
    const std::vector<double> y = evaluate_sh(order, Vec3(std::sqrt((1 - z) * (1 + z)), 0, z));  // phi = 0
    for (int i = 0; i < size; ++i) polar[i][n] = y[sh_index(index[i].l, std::abs(index[i].m))];
  }
  const Azimuth azimuth(order);
  for (int i = 0; i < size; ++i)
    for (int j = i; j < size; ++j)
      for (int k = j; k < size; ++k) {
        const auto &a = index[i], &b = index[j], &c = index[k];  // l ascends with the index
        if ((a.l + b.l + c.l) % 2 != 0 || c.l > a.l + b.l) continue;
        const double around = azimuth(a.m, b.m, c.m);
        if (std::abs(around) < 1e-12) continue;
        double sum = 0;
        for (int n = 0; n < nodes; ++n) sum += rule.weight[n] * polar[i][n] * polar[j][n] * polar[k][n];
        if (std::abs(sum * around) > 1e-13) terms_.push_back({i, j, k, sum * around});
      }
}

namespace {

template <class T>
std::vector<T> product_of(const TripleProduct& tensor, const std::vector<T>& f, const std::vector<double>& h) {
  const int order = tensor.order();
  const std::size_t size = std::size_t(order) * order;
  if (f.size() != size || h.size() != size)
    throw Error(fmt::format("a product of harmonics of {} and {} coefficients, expected {}", f.size(), h.size(), size));
  std::vector<T> product(size, T(0.0 * f[0]));
  for (const TripleProduct::Term& t : tensor.terms()) {
    const auto [i, j, k, value] = t;
    // Every distinct order of the three indices once.
    if (i == j && j == k) {
      product[i] += value * h[i] * f[i];
    } else if (i == j) {
      product[i] += value * (h[i] * f[k] + h[k] * f[i]);
      product[k] += value * h[i] * f[i];
    } else if (j == k) {
      product[j] += value * (h[j] * f[i] + h[i] * f[j]);
      product[i] += value * h[j] * f[j];
    } else {
      product[i] += value * (h[j] * f[k] + h[k] * f[j]);
      product[j] += value * (h[i] * f[k] + h[k] * f[i]);
      product[k] += value * (h[i] * f[j] + h[j] * f[i]);
    }
  }
  return product;
}

}  // namespace

std::vector<Rgb> TripleProduct::operator()(const std::vector<Rgb>& f, const std::vector<double>& h) const {
  return product_of(*this, f, h);
}
std::vector<double> TripleProduct::operator()(const std::vector<double>& f, const std::vector<double>& h) const {
  return product_of(*this, f, h);
}

const TripleProduct& triple_product(int order) {
  static std::mutex mutex;
  static std::array<std::unique_ptr<const TripleProduct>, greatest_product_order + 1> kept;
  if (order < 1 || order > greatest_product_order) TripleProduct refused(order);  // throws
  const std::lock_guard lock(mutex);
  if (!kept[order]) kept[order] = std::make_unique<const TripleProduct>(order);
  return *kept[order];
}

}  // namespace airlight::scene
