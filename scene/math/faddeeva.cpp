#include "scene/math/faddeeva.h"

#include <array>
#include <cmath>

#include "scene/math/types.h"

namespace airlight::scene {
namespace {

constexpr int terms = 48;
const double root_pi = std::sqrt(pi);

// Coefficients of w in powers of (L + iz)/(L - iz): the Fourier coefficients of (L^2 + t^2) exp(-t^2) over the angle
// 2 atan(t/L).
struct Weideman {
  double L = std::sqrt(terms / std::sqrt(2.0));
  std::array<double, terms> a{};
  Weideman() {
    constexpr int points = 4 * terms;
    for (int k = -points + 1; k < points; ++k) {
      const double angle = k * pi / points, t = L * std::tan(angle / 2);
      const double value = std::exp(-t * t) * (L * L + t * t);
      for (int n = 0; n < terms; ++n) a[n] += value * std::cos((n + 1) * angle) / (2 * points);
    }
  }
};

std::complex<double> rational(std::complex<double> z) {
  static const Weideman table;
  const std::complex<double> iz(-z.imag(), z.real()), below = table.L - iz, q = (table.L + iz) / below;
  // By parts: products of std::complex look for infinities, which costs as much again.
  const double qr = q.real(), qi = q.imag();
  double re = table.a[terms - 1], im = 0;
  for (int n = terms - 2; n >= 0; --n) {
    const double next = re * qr - im * qi + table.a[n];
    im = re * qi + im * qr;
    re = next;
  }
  return 2.0 * std::complex<double>(re, im) / (below * below) + 1 / root_pi / below;
}

}  // namespace

std::complex<double> faddeeva(std::complex<double> z) {
  if (std::norm(z) > 64) {
    // i/sqrt(pi) / (z - (1/2)/(z - (2/2)/(z - (3/2)/ ...))): no step cancels in either part.
    std::complex<double> tail = z;
    for (int n = 24; n >= 1; --n) tail = z - 0.5 * n / tail;
    const std::complex<double> inverse = 1.0 / tail;
    return {-inverse.imag() / root_pi, inverse.real() / root_pi};
  }
  const double x = z.real(), y = z.imag();
  if (y > 1e-2) return rational(z);
  // Close to the real axis the real part is small beside the imaginary one: Taylor series from the axis, where it is
  // exp(-x^2). The derivatives follow from w' = -2 z w + 2i/sqrt(pi).
  std::complex<double> w(std::exp(-x * x), rational(x).imag()),
      slope = -2 * x * w + std::complex<double>(0, 2 / root_pi);
  std::complex<double> sum = w, power(1, 0);
  for (int n = 1; n <= 8; ++n) {
    power *= std::complex<double>(0, y / n);
    sum += power * slope;
    const std::complex<double> next = -2 * x * slope - 2.0 * n * w;
    w = slope;
    slope = next;
  }
  return sum;
}

}  // namespace airlight::scene
