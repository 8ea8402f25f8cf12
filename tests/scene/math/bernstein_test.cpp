#include "scene/math/bernstein.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

namespace bernstein_test {

using namespace airlight;

namespace {

Bernstein through(const std::function<double(double)>& f) {
  Bernstein values;
  for (int k = 0; k < bernstein_size; ++k) values[k] = f(bernstein_nodes()[k]);
  return bernstein_through(values);
}

double value(const Bernstein& p, double s) {
  double sum = 0, binomial = 1;
  for (int k = 0; k < bernstein_size; ++k) {
    sum += binomial * std::pow(s, k) * std::pow(1 - s, bernstein_size - 1 - k) * p[k];
    binomial *= double(bernstein_size - 1 - k) / (k + 1);
  }
  return sum;
}

}  // namespace

// Ten coefficients hold a polynomial of degree nine; values to coefficients has a condition of some hundreds.
TEST_CASE("polynomials through Chebyshev nodes in Bernstein form", "[media]") {
  const auto p = [](double s) { return 3 - s + 2 * std::pow(s, 4) - 5 * std::pow(s, 9); };
  const Bernstein b = through(p);
  for (int i = 0; i <= 50; ++i) CHECK(value(b, i / 50.0) == Approx(p(i / 50.0)).margin(1e-12));
  CHECK(b.front() == Approx(p(0)).margin(1e-12));
  CHECK(b.back() == Approx(p(1)).margin(1e-12));
}

TEST_CASE("the positive part of a polynomial", "[media]") {
  const auto integral = [](const std::function<double(double)>& f) {
    return integral_of_positive_part(through(f), 1e-15);
  };
  CHECK(integral([](double) { return 2; }) == Approx(2).epsilon(1e-13));
  CHECK(integral([](double) { return -2; }) == 0);
  CHECK(integral([](double) { return 0; }) <= 1e-15);
  // s - r is positive over (r, 1]: (1 - r)^2 / 2, wherever the zero lies.
  for (double r : {0.0, 1e-9, 0.1, 1.0 / 3, 0.5, 0.999, 1.0})
    CHECK(integral([&](double s) { return s - r; }) == Approx((1 - r) * (1 - r) / 2).margin(1e-13));
  // A double zero inside: nothing to cut off. (s - r)^2 integrates to ((1 - r)^3 + r^3) / 3.
  CHECK(integral([](double s) { return (s - 0.3) * (s - 0.3); }) == Approx((0.343 + 0.027) / 3).margin(1e-13));
  CHECK(integral([](double s) { return -(s - 0.3) * (s - 0.3); }) <= 1e-13);
  // (s - 1/4)(s - 3/4) has the antiderivative s^3/3 - s^2/2 + 3s/16, which is 1/48 at 1/4; by symmetry twice that
  // outside.
  CHECK(integral([](double s) { return (s - 0.25) * (s - 0.75); }) == Approx(1.0 / 24).margin(1e-13));
}

}  // namespace bernstein_test
