#include "scene/math/quadrature.h"

#include <catch2/catch.hpp>

namespace quadrature_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

Rgb grey(double v) { return Rgb::Constant(v); }

}  // namespace

// A Kronrod rule of 2n+1 nodes over n Gauss nodes is exact to degree 3n+1 (n even) or 3n+2 (n odd): 11 and 23. The next
// even degree must fail, or the table would be another one.
TEST_CASE("Kronrod rules are exact to their degree and not beyond", "[quadrature]") {
  for (const auto& [rule, degree] : {std::pair{&kronrod7(), 11}, std::pair{&kronrod15(), 23}}) {
    for (int power = 0; power <= degree + 1; ++power) {
      Panel p{-1, 1};
      estimate_panel([power = power](int, double x) { return grey(std::pow(x, power)); }, *rule, p);
      const double exact = power % 2 ? 0 : 2.0 / (power + 1);
      CAPTURE(degree, power);
      if (power <= degree)
        CHECK(std::abs(p.value[0] - exact) < 1e-15);
      else
        CHECK(std::abs(p.value[0] - exact) > 1e-10);
    }
  }
}

// The error claimed must bound the error made, for integrands from smooth to kinked, in every channel; closed forms.
TEST_CASE("adaptive quadrature meets its tolerance and does not overstate it", "[quadrature]") {
  const auto f = [](int, double x) { return Rgb(std::exp(-50 * x), std::abs(x - 1 / pi), 1 / (x * x + 1e-4)); };
  const Rgb exact((1 - std::exp(-50.0)) / 50, 0.5 / (pi * pi) + 0.5 * (1 - 1 / pi) * (1 - 1 / pi),
                  100 * std::atan(100.0));
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (const KronrodRule* rule : {&kronrod7(), &kronrod15()}) {
      QuadratureOptions options;
      options.relative_tolerance = tolerance;
      options.rule = rule;
      const Integral r = integrate(f, {{0, 1}}, options);
      CAPTURE(tolerance, r.evaluations);
      CHECK(r.converged);
      for (int c = 0; c < 3; ++c) {
        CHECK(std::abs(r.value[c] - exact[c]) <= tolerance * exact[c] + 1e-15);
        CHECK(r.error[c] <= tolerance * exact[c]);
      }
    }
  }
}

TEST_CASE("running out of evaluations is said", "[quadrature]") {
  QuadratureOptions options;
  options.max_evaluations = 60;
  const Integral r = integrate([](int, double x) { return grey(std::sqrt(std::abs(x - 0.3))); }, {{0, 1}}, options);
  CHECK_FALSE(r.converged);
  CHECK(r.evaluations <= 60);
  CHECK(r.error[0] > 0);
}

// With the constant density, int dx f / (x^2+h^2) over [xa, xb]. f = 1: (atan(xb/h) - atan(xa/h))/h, here in the form
// without cancellation; f = x (xa > 0): log((xb^2+h^2)/(xa^2+h^2))/2.
TEST_CASE("equal angles take the inverse square away", "[quadrature]") {
  for (const double h : {0.0, 1e-9, 1e-3, 1.0, 1e6})
    for (const auto& [xa, xb] : {std::pair{1e-3, 4.0}, std::pair{2.0, 2.0000001}, std::pair{0.5, 700.0}})
      for (const double sign : {1.0, -1.0}) {
        const EquiangularMap map(sign > 0 ? xa : -xb, sign > 0 ? xb : -xa, h);
        const double angle = h > 0 ? std::atan2(h * (xb - xa), h * h + xa * xb) / h : (xb - xa) / (xa * xb);
        CAPTURE(h, xa, xb, sign);
        CHECK(map.density() == Approx(angle).epsilon(1e-14));
        CHECK(map.x(0) == Approx(sign > 0 ? xa : -xb).epsilon(1e-12));
        CHECK(map.x(1) == Approx(sign > 0 ? xb : -xa).epsilon(1e-12));
        const Integral r =
            integrate([&](int, double u) { return grey(std::abs(map.x(u)) * map.density()); }, {{0, 1}}, {1e-12});
        CHECK(r.value[0] == Approx(0.5 * std::log1p((xb - xa) * (xb + xa) / (xa * xa + h * h))).epsilon(1e-11));
      }
}

TEST_CASE("equal angles reach to infinity and to the foot", "[quadrature]") {
  for (const double h : {1e-9, 0.3, 50.0}) {
    CHECK(EquiangularMap(0, infinity, h).density() == Approx(0.5 * pi / h).epsilon(1e-14));
    CHECK(EquiangularMap(-infinity, 0, h).density() == Approx(0.5 * pi / h).epsilon(1e-14));
    CHECK(EquiangularMap(0, infinity, h).x(0.5) == Approx(h).epsilon(1e-14));
    CHECK(EquiangularMap(-2, 0, h).x(1) == Approx(0.0).margin(1e-15));
  }
  CHECK(EquiangularMap(2, infinity, 0).density() == 0.5);
  CHECK(EquiangularMap(2, infinity, 0).x(0.5) == Approx(4.0));
  CHECK(std::isinf(EquiangularMap(0, 1, 0).density()));
}

}  // namespace quadrature_test
