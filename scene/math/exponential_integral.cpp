#include "scene/math/exponential_integral.h"

#include <cmath>

namespace airlight::scene {
namespace {

using Complex = std::complex<double>;

// std::complex multiplication and division handle infinities and are slow for it; every operand here is finite.
Complex times(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
Complex inverse(Complex a) {
  const double n = 1 / (a.real() * a.real() + a.imag() * a.imag());
  return {a.real() * n, -a.imag() * n};
}

// E1(z) = -gamma - log z - sum (-z)^k / (k k!). In the right half plane it cancels by about e^(2 Re z).
Complex by_series(Complex z) {
  constexpr double euler_gamma = 0.57721566490153286061;
  Complex power = 1, sum = 0;
  for (int k = 1; k <= 40; ++k) {
    power = times(power, -z) / double(k);
    sum += power / double(k);
    if (std::norm(power) < 1e-36 * std::norm(sum)) break;
  }
  const Complex log_z(0.5 * std::log(std::norm(z)), std::arg(z));
  return times(std::exp(z), -euler_gamma - log_z - sum);
}

// 1/(z+1 - 1/(z+3 - 4/(z+5 - 9/(z+7 - ...)))) from the bottom up. The depth is where the tail stops to matter in double
// precision; it was found by comparing with 40-digit values along the imaginary axis, where convergence is slowest.
Complex by_continued_fraction(Complex z) {
  const int depth = 6 + int(180 / std::sqrt(std::norm(z)));
  Complex tail = z + double(2 * depth + 1);
  for (int k = depth; k >= 1; --k) tail = z + double(2 * k - 1) - double(k) * double(k) * inverse(tail);
  return inverse(tail);
}

}  // namespace

Complex scaled_exponential_integral(Complex z) {
  // |z| beyond 1e150 would overflow in the norm; there the first term of the fraction is exact. For NaN the depth of
  // the fraction would be undefined.
  if (!(std::abs(z.real()) + std::abs(z.imag()) <= 1e100)) return 1.0 / z;
  return std::norm(z) < 4 ? by_series(z) : by_continued_fraction(z);
}

}  // namespace airlight::scene
