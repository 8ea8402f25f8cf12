// The map of stability and the errors of the evaluators against values that are computed another way.
#include "experiments/shadow_planes/evaluator_errors.h"

#include <catch2/catch.hpp>

#include "experiments/shadow_planes/light_on_ray.h"
#include "methods/shadow_planes/polynomial.h"
#include "scene/math/exponential_integral.h"
#include "scene/math/quadrature.h"
#include "tests/methods/shadow_planes/vectors.h"

namespace evaluator_errors_test {

using namespace airlight;
using namespace airlight::shadow_planes;
using namespace airlight::experiments::shadow_planes;
using namespace shadow_planes_test;

namespace {

// Along the ray, in its distance form (Biri et al. 2006, Eq. 1).
double by_quadrature(const LightOnRay<double>& on) {
  const auto f = [&](int, double x) {
    const double r = std::hypot(x - on.T, on.h);
    return Rgb::Constant(std::exp(-on.extinction * (x + r)) / (r * r));
  };
  std::vector<scene::Panel> panels;
  double from = on.begin;
  // Every panel twice as far from the light's foot point as the one before: the integrand is smooth on each.
  std::vector<double> cuts{on.T};
  for (double d = on.h; d < 2 * map_foot; d *= 2) cuts.insert(cuts.end(), {on.T - d, on.T + d});
  cuts.push_back(on.begin + on.length);
  std::sort(cuts.begin(), cuts.end());
  for (const double cut : cuts)
    if (cut > from && cut <= on.begin + on.length) {
      panels.push_back({from, cut});
      from = cut;
    }
  scene::QuadratureOptions options;
  options.relative_tolerance = 1e-13;
  return on.extinction / (4 * pi) * scene::integrate(f, panels, options).value[0];
}

}  // namespace

TEST_CASE("shadow planes: the reference of the map", "[shadow_planes]") {
  const MappedRule<double> rule(128, 6);
  int vectors = 0;
  for (const json& v : vectors_of("airlight")) {
    const json& in = v.at("input");
    if (in.at("phase") != "iso" || !(number(in.at("h")) > 0)) continue;
    const double k = number(in.at("k_t")), T = number(in.at("T")), h = number(in.at("h")), x0 = number(in.at("x0")),
                 x1 = number(in.at("x1")), expected = number(v.at("expect").at("L"));
    if (!(expected > 1e-300)) continue;
    const double got = by_rule(LightOnRay<double>{k, T, h, x0, x1 - x0}, rule);
    const double near = std::isinf(x1) ? 0 : std::max({x0, x1, std::abs(T)}) / (x1 - x0);
    CAPTURE(v.at("id").get<std::string>());
    CHECK(got * number(in.at("albedo")) * number(in.at("intensity")) ==
          Approx(expected).epsilon(2e-14 + 4e-16 * (k * (x0 + std::hypot(x0 - T, h)) + near)));
    ++vectors;
  }
  CHECK(vectors > 10);
  // Endless: -Im e^z E1(z), z = a (q0 + i).
  for (const double k : {1e-6, 1e-2, 1.0, 30.0})
    for (const double h : {1e-2, 1.0, 100.0}) {
      const double q0 = q_at(-map_foot, h), a = k * h;
      const double exact = -2 * scene::scaled_exponential_integral({a * q0, a}).imag() * k / (4 * pi * h) *
                           std::exp(-k * std::hypot(map_foot, h));
      CHECK(by_rule(LightOnRay<double>{k, map_foot, h, 0, infinity}, rule) == Approx(exact).epsilon(2e-13 * (1 + q0)));
    }
}

TEST_CASE("shadow planes: cells of the map of stability", "[shadow_planes]") {
  const auto error = [](Evaluator::Form form, int terms, bool single, double k, double h) {
    return map_error({form, terms, single}, k, h);
  };
  constexpr auto polynomial = Evaluator::Form::polynomial, differences = Evaluator::Form::differences,
                 rule = Evaluator::Form::rule;
  for (const double k : {1e-5, 1e-2, 0.3, 2.0})
    for (const double h : {1e-3, 0.05, 1.0, 20.0}) {
      CAPTURE(k, h);
      CHECK(map_reference_error(k, h) < 1e-14);
      double expected = 0, first = 0;
      for (const auto& [begin, length] : map_parts) {
        const LightOnRay<double> on{double(float(k)), map_foot, double(float(h)), begin, length};
        const double exact = by_quadrature(on), a = on.extinction * on.h;
        const auto gamma = [&](double x0, double x1) {
          return polynomial_airlight(taylor_coefficients(PhaseForm{}, a, 4), 0, on.extinction, 1, 1, on.T, on.h,
                                     std::atan((x0 - on.T) / on.h), std::atan((x1 - on.T) / on.h));
        };
        expected = std::max(expected, std::abs(gamma(begin, begin + length) / exact - 1));
        first = std::max(first, std::abs(by_rule(on, MappedRule<double>(32, 6)) / exact - 1));
        CHECK(by_rule(on, MappedRule<double>(128, 6)) == Approx(exact).epsilon(1e-12));
      }
      CHECK(error(polynomial, 4, false, k, h) == Approx(expected).epsilon(1e-6).margin(1e-11));
      CHECK(error(rule, 32, false, k, h) == Approx(first).margin(1e-12));
      // Single precision and differences only add rounding: what they add is small where h is not.
      if (h >= 1) {
        CHECK(error(differences, 4, false, k, h) == Approx(expected).epsilon(1e-6).margin(1e-11));
        CHECK(error(polynomial, 4, true, k, h) == Approx(expected).epsilon(1e-2).margin(3e-5));
      }
      CHECK(error(rule, 8, true, k, h) < 4e-4);
      CHECK(error(rule, 16, true, k, h) < 1e-5);
      CHECK(error(rule, 64, false, k, h) < 1e-14);
    }
  // Too dark for either precision, and for single alone.
  CHECK(std::isnan(error(rule, 64, false, 1e4, 1)));
  CHECK(std::isnan(error(rule, 16, true, 30, 1)));
  CHECK(error(rule, 64, false, 30, 1) < 1e-13);
}

TEST_CASE("shadow planes: polynomials without memory of their own", "[shadow_planes]") {
  for (const double a : {1e-3, 0.5, 4.0})
    for (const int degree : {0, 2, 7, 12}) {
      const double expected = integrate_polynomial(taylor_coefficients(PhaseForm{}, a, degree), 0, -0.9, 1.1);
      CHECK(FixedPolynomial<double>(a, degree).integral(-0.9, 1.1) == Approx(expected).epsilon(1e-13));
      CHECK(FixedPolynomial<float>(float(a), degree).integral(-0.9f, 1.1f) == Approx(expected).epsilon(2e-5));
    }
}

// Medians of the specification's table, section 3, to one digit.
TEST_CASE("shadow planes: errors of the polynomial over angles", "[shadow_planes]") {
  constexpr int degrees[] = {2, 4, 6, 8, 12};
  struct Line {
    double reach, a_low, a_high, medians[5];
  };
  const Line lines[] = {
      {0.25, 1e-6, 1e-2, {3e-8, 2e-10, 2e-12, 2e-14, 2e-16}}, {0.25, 0.3, 3, {6e-5, 4e-7, 2e-9, 2e-11, 3e-15}},
      {0.25, 3, 30, {8e-2, 3e-3, 3e-5, 2e-7, 5e-12}},         {0.8, 1e-2, 0.3, {6e-4, 5e-5, 5e-6, 4e-7, 4e-9}},
      {0.8, 0.3, 3, {2e-3, 1e-4, 9e-6, 1e-6, 1e-8}},          {0.8, 3, 30, {0.8, 0.3, 5e-2, 4e-3, 2e-5}},
      {1.5, 1e-6, 1e-2, {7e-6, 2e-6, 8e-7, 3e-7, 5e-8}},      {1.5, 1e-2, 0.3, {5e-3, 1e-3, 4e-4, 1e-4, 2e-5}},
      {1.5, 0.3, 3, {2e-2, 3e-3, 8e-4, 3e-4, 4e-5}}};
  for (const Line& line : lines)
    for (int d = 0; d < 5; ++d) {
      CAPTURE(line.reach, line.a_low, line.a_high, degrees[d]);
      const double median = errors_over_angles(degrees[d], line.reach, line.a_low, line.a_high, 4000).median;
      CHECK(median > line.medians[d] / 3);
      CHECK(median < line.medians[d] * 3);
    }
}

}  // namespace evaluator_errors_test
