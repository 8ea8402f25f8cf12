#include "methods/fogshop/homogeneous_airlight.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/methods/fogshop/vectors.h"

namespace homogeneous_airlight_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::relative_error;

TEST_CASE("F at its limits", "[fogshop]") {
  CHECK(F(0, 0.7) == 0.7);
  CHECK(F(3, 0) == 0);
  // Thirteen digits of the stress table.
  CHECK(F(1e-12, 1.5707963267948966) == Approx(1.570796326767).epsilon(1e-12));
  CHECK(F(1e4, 1.5707963267948966) == Approx(9.9999998e-5).epsilon(1e-13));
  // Small v: F(u, v) = v - u v^2/2 + O(v^3), where a difference of two closed forms would keep 8 digits.
  CHECK(relative_error(F(1, 1e-8), 1e-8 - 0.5e-16) <= 1e-15);
}

TEST_CASE("homogeneous airlight, stress table", "[fogshop]") {
  const double right_angle = pi / 2;
  CHECK(homogeneous_airlight(0.5, 1, 0, 1) == 0);
  CHECK(homogeneous_airlight(0.5, 1, 2, 0) == 0);
  CHECK(homogeneous_airlight(right_angle, 1, infinity, 1e-8) == Approx(1.249999705613e-9).epsilon(1e-12));
  CHECK(homogeneous_airlight(1e-8, 1, 0.5, 1) == Approx(0.02927491576216).epsilon(1e-12));
  CHECK(homogeneous_airlight(1e-8, 1, 2, 1) == Approx(9.196984895631e6).epsilon(1e-12));
  CHECK(homogeneous_airlight(pi, 1, infinity, 1) == Approx(0.008119186118439).epsilon(1e-12));
  CHECK(homogeneous_airlight(1, 1, infinity, 1e4) == 0);  // 2e-4344
  CHECK(homogeneous_airlight(2, 1e-6, infinity, 1) == Approx(99904.72513203).epsilon(1e-12));
  CHECK(std::isinf(homogeneous_airlight(0, 1, 2, 1)));  // through the light
  CHECK(std::isinf(homogeneous_airlight(0, 0, 2, 1)));  // light at the camera
  CHECK(softened_homogeneous_airlight({0, 0}, infinity, 0.5, 0.01) == Approx(6.049635435552).epsilon(1e-12));
}

// The definition by Simpson's rule in the angle as seen from the (softened) light. Shares nothing with the closed form.
static double brute_force(const LightFromRay& light, double d_vp, double beta, double radius) {
  const double soft = std::hypot(light.h, radius);
  const auto integrand = [&](double x) {
    return std::exp(-beta * (light.along + x + std::hypot(x, light.h))) / (x * x + soft * soft);
  };
  // x = soft tan(theta), dx = (x^2 + soft^2) / soft dtheta.
  const double from = std::atan(-light.along / soft), to = std::atan((d_vp - light.along) / soft);
  const int n = 200000;
  long double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const double theta = from + (to - from) * i / n, x = soft * std::tan(theta);
    sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * integrand(x) * (x * x + soft * soft) / soft;
  }
  return beta / (4 * pi) * double(sum) * (to - from) / n / 3;
}

TEST_CASE("homogeneous airlight against plain quadrature", "[fogshop]") {
  std::mt19937 random(1);
  const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (random() / 4294967296.0); };
  for (int i = 0; i < 60; ++i) {
    const LightFromRay light{uniform(-4, 8), uniform(0.5, 3)};
    const double d_vp = uniform(0.5, 12), beta = std::pow(10, uniform(-3, 0.5)), radius = i % 2 ? 0.3 : 0.0;
    INFO(light.along << " " << light.h << " " << d_vp << " " << beta << " " << radius);
    // Simpson with 2e5 intervals of a function whose fourth derivative is below 1e8 of itself: 1e-15, plus rounding.
    CHECK(relative_error(softened_homogeneous_airlight(light, d_vp, beta, radius),
                         brute_force(light, d_vp, beta, radius)) <= 1e-11);
  }
}

// Two segments end to end add, also where one of them is so short or so close to the light that the closed form would
// cancel: L(d) = L(d1) + e^(-beta d1) L'(d - d1) with the light seen from the second origin.
TEST_CASE("homogeneous airlight of two segments adds", "[fogshop]") {
  std::mt19937 random(2);
  const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (random() / 4294967296.0); };
  for (int i = 0; i < 2000; ++i) {
    const double h = std::pow(10, uniform(-9, 0)), along = uniform(-2, 4), beta = std::pow(10, uniform(-6, 1));
    const double d = uniform(0.1, 5),
                 d1 = d * (i % 2 ? std::pow(10, uniform(-8, 0)) : 1 - std::pow(10, uniform(-3, 0)));
    const double whole = homogeneous_airlight(LightFromRay{along, h}, d, beta);
    const double parts = homogeneous_airlight(LightFromRay{along, h}, d1, beta) +
                         std::exp(-beta * d1) * homogeneous_airlight(LightFromRay{along - d1, h}, d - d1, beta);
    INFO(along << " " << h << " " << d << " " << d1 << " " << beta);
    // Each term is good to 1e-12; along - d1 is rounded by 4e-16, which counts relative to the cut's distance from the
    // light.
    const double closeness = std::hypot(h, along - d1);
    CHECK(relative_error(parts, whole) <= 2e-12 + 1e-15 / closeness);
  }
}

}  // namespace homogeneous_airlight_test
