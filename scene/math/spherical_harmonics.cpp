#include "scene/math/spherical_harmonics.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::scene {
namespace {

// Factors of the recurrence in l at fixed m for Q_lm = sqrt(2) K P_l^m / sin^m(theta) (no sqrt(2) at m = 0):
//   Q_lm = up[l][m] z Q_(l-1)m - back[l][m] Q_(l-2)m
// It runs upwards in l, which is stable, and never divides by the sine.
struct Factors {
  std::array<double, max_sh_order> first;  // Q_mm
  std::array<std::array<double, max_sh_order>, max_sh_order> up, back;

  Factors() {
    double diagonal = 1 / (4 * pi);  // K_mm^2 (2m-1)!!^2
    for (int m = 0; m < max_sh_order; ++m) {
      if (m > 0) diagonal *= (2 * m + 1) / (2.0 * m);
      first[m] = (m % 2 ? -1 : 1) * std::sqrt((m > 0 ? 2 : 1) * diagonal);
      for (int l = m + 1; l < max_sh_order; ++l) {
        const double span = double(l - m) * (l + m);
        up[l][m] = std::sqrt((2.0 * l - 1) * (2.0 * l + 1) / span);
        back[l][m] = std::sqrt((2.0 * l + 1) * (l - 1.0 - m) * (l - 1.0 + m) / ((2.0 * l - 3) * span));
      }
    }
  }
};

const Factors& factors() {
  static const Factors table;
  return table;
}

}  // namespace

void evaluate_sh(int order, const Vec3& direction, double* values) {
  if (order < 1 || order > max_sh_order)
    throw Error(fmt::format("spherical harmonics of order {}, expected 1 to {}", order, max_sh_order));
  const Factors& f = factors();
  const double x = direction[0], y = direction[1], z = direction[2];
  double c = 1, s = 0;  // real and imaginary part of (x + iy)^m = sin^m(theta) e^(i m phi)
  for (int m = 0; m < order; ++m) {
    double before = 0, q = f.first[m];
    for (int l = m; l < order; ++l) {
      if (l > m) {
        const double next = f.up[l][m] * z * q - (l > m + 1 ? f.back[l][m] * before : 0);
        before = q;
        q = next;
      }
      values[sh_index(l, m)] = q * c;
      if (m > 0) values[sh_index(l, -m)] = q * s;
    }
    const double turned = c * x - s * y;
    s = c * y + s * x;
    c = turned;
  }
}

std::vector<double> evaluate_sh(int order, const Vec3& direction) {
  std::vector<double> values(std::size_t(order > 0 ? order * order : 0));
  evaluate_sh(order, direction, values.data());
  return values;
}

Rgb evaluate_sh(const std::vector<Rgb>& coefficients, const Vec3& direction) {
  std::array<double, max_sh_order * max_sh_order> basis;
  evaluate_sh(int(std::lround(std::sqrt(double(coefficients.size())))), direction, basis.data());
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < coefficients.size(); ++i) sum += coefficients[i] * basis[i];
  return sum;
}

}  // namespace airlight::scene
