// The evaluators of the airlight integral against the oracle vectors, and each other.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "methods/shadow_planes/mapped_rule.h"
#include "methods/shadow_planes/polynomial.h"
#include "methods/shadow_planes/rule_sum.h"
#include "scene/base/error.h"
#include "scene/math/exponential_integral.h"
#include "tests/methods/shadow_planes/rule_cases.h"
#include "tests/methods/shadow_planes/vectors.h"

namespace evaluators_test {

using namespace airlight;
using namespace airlight::shadow_planes;
using namespace shadow_planes_test;

namespace {

// Error through the rounding of the input, in units of the machine's precision.
double conditioning(double k, double T, double h, double x0, double x1) {
  const double near = std::isinf(x1) ? 0 : std::max({std::abs(x0), std::abs(x1), std::abs(T)}) / (x1 - x0);
  return 1 + k * (x0 + std::hypot(x0 - T, h)) + near;
}

}  // namespace

TEST_CASE("shadow planes: airlight vectors", "[shadow_planes]") {
  const MappedRule<double> rule(64, 6), fast(32, 6);
  const MappedRule<float> single(16, 3);
  int count = 0;
  for (const json& v : vectors_of("airlight")) {
    const json& in = v.at("input");
    const double k = number(in.at("k_t")), T = number(in.at("T")), h = number(in.at("h")), x0 = number(in.at("x0")),
                 x1 = number(in.at("x1")), albedo = number(in.at("albedo")), intensity = number(in.at("intensity"));
    const PhaseForm phase = phase_of(in);
    const double condition = conditioning(k, T, h, x0, x1);
    CAPTURE(v.at("id").get<std::string>(), condition);
    const LitPart<double> part{x0, x1 - x0};
    const double expected = number(v.at("expect").at("L"));
    const double got = lit_airlight(rule, phase, k, albedo, intensity, T, h, part);
    const auto one = [](auto, auto, auto) { return 1; };
    const double shape = airlight_integral(rule, phase, k, T, h, part, one);
    if (expected > 1e-300) CHECK(std::abs(got - expected) < (5e-14 + 4e-16 * condition) * expected);
    // The lesser rules, on the same segment: their greatest errors (murky), and three roundings of the input.
    const double quick = airlight_integral(fast, phase, k, T, h, part, one);
    CHECK(std::abs(quick - shape) < (1e-6 + 4e-16 * condition) * shape);
    const float s =
        airlight_integral(single, phase, float(k), float(T), float(h), LitPart<float>{float(x0), float(x1 - x0)}, one);
    CAPTURE(s, shape);
    if (h > 0 || x0 > T || x1 < T)
      CHECK(std::abs(s - shape) <
            (1e-4 + 2e-7 * (condition + std::abs(T) / std::max({h, 1e-3 * std::abs(T), 1e-30}))) * shape);
    ++count;
  }
  CHECK(count == 38);
}

// The form that shaders take: polynomials in a.
TEST_CASE("shadow planes: coefficients as polynomials in a", "[shadow_planes]") {
  for (const scene::PhaseFunction& p :
       {scene::PhaseFunction(scene::Isotropic{}), scene::PhaseFunction(scene::Rayleigh{}),
        scene::PhaseFunction(scene::Hazy{}), scene::PhaseFunction(scene::HenyeyGreenstein{0.6})})
    for (const double a : {1e-3, 0.7, 3.0}) {
      const auto rows = coefficients_in_a(phase_form(p), 8);
      const std::vector<double> c = taylor_coefficients(phase_form(p), a, 8);
      REQUIRE(rows.size() == c.size());
      for (std::size_t n = 0; n < c.size(); ++n) {
        double sum = 0;
        for (std::size_t k = 0; k < rows[n].size(); ++k) sum += rows[n][k] * std::pow(a, double(k));
        CHECK(sum == Approx(c[n]).epsilon(1e-11).margin(1e-12));
      }
    }
}

// The annex as printed (section 2 of the corrections): which coefficients are wrong, and by how much.
TEST_CASE("shadow planes: the printed coefficients and their errors", "[shadow_planes]") {
  const double a = 0.7;
  const auto differences = [&](const scene::PhaseFunction& p) {
    const PhaseForm phase = phase_form(p, true);
    std::vector<double> printed = printed_coefficients(phase, a);
    const std::vector<double> right = taylor_coefficients(phase, a, int(printed.size()) - 1);
    for (std::size_t n = 0; n < printed.size(); ++n) printed[n] -= right[n];
    return printed;
  };
  const auto is = [](const std::vector<double>& got, const std::vector<double>& expected) {
    REQUIRE(got.size() == expected.size());
    for (std::size_t n = 0; n < got.size(); ++n) CHECK(got[n] == Approx(expected[n]).margin(1e-14));
  };
  is(differences(scene::Isotropic{}), {0, 0, a * a / 2 - a / 2, -a * a / 6 + a * a * a / 6 - a + a / 3, 0});
  is(differences(scene::Rayleigh{}), {0, 0, 3 * a / 8});
  is(differences(scene::Hazy{}), {0, 9.0 / 36 + 9.0 / 32, 265 * a * a / 512});
  const double p = 2147483673.0 / 2147483648;
  is(differences(scene::Murky{}), {0, 2 * p * a - 25.0 / 367108864 + 25.0 / 67108864, 0});
  CHECK_THROWS_AS(printed_coefficients(phase_form(scene::HenyeyGreenstein{0.5}), a), Error);
}

// Isotropic: the integral has a closed form, -Im e^z E1(z) at z = a (q0 + i), over an infinite ray.
TEST_CASE("shadow planes: the rule against the closed form", "[shadow_planes]") {
  const MappedRule<double> rule(64, 6);
  for (const double a : {1e-6, 1e-3, 0.1, 1.0, 7.0, 300.0})
    for (const double x0 : {-100.0, -3.0, -0.2, 0.0, 0.4, 5.0, 1000.0}) {
      const double q0 = q_at(x0, 1.0);
      const double exact = -2 * scene::scaled_exponential_integral({a * q0, a}).imag();
      const double got = airlight_integral(rule, PhaseForm{}, a, 0.0, 1.0, LitPart<double>{x0, infinity},
                                           [](double, double, double) { return 1.0; });
      CAPTURE(a, x0);
      // The closed form is a difference where q0 is large.
      CHECK(std::abs(got - exact) < 1e-13 * exact * (1 + q0));
    }
}

// The table of mapped_rule.h. Against 256 nodes in double.
TEST_CASE("shadow planes: errors of the rules", "[shadow_planes]") {
  const MappedRule<double> truth(256, 6), d32(32, 6), d64(64, 6);
  const MappedRule<float> f8(8, 2), f16(16, 3);
  const auto one = [](auto, auto, auto) { return 1; };
  for (const RuleErrors& row : rule_errors()) {
    double worst[4] = {0, 0, 0, 0};
    for (const auto& [a, d0, length] : rule_cases()) {
      const LitPart<double> part{0, length};
      const LitPart<float> single{0, length};
      const double exact = airlight_integral(truth, row.phase, double(a), double(-d0), 1.0, part, one);
      const double got[4] = {airlight_integral(f8, row.phase, a, -d0, 1.0f, single, one),
                             airlight_integral(f16, row.phase, a, -d0, 1.0f, single, one),
                             airlight_integral(d32, row.phase, double(a), double(-d0), 1.0, part, one),
                             airlight_integral(d64, row.phase, double(a), double(-d0), 1.0, part, one)};
      for (int k = 0; k < 4; ++k) worst[k] = std::max(worst[k], std::abs(got[k] - exact) / exact);
    }
    CAPTURE(int(row.phase.kind), row.phase.g, worst[0], worst[1], worst[2], worst[3]);
    CHECK(worst[0] < row.float_8);
    CHECK(worst[1] < row.float_16);
    CHECK(worst[2] < row.double_32);
    CHECK(worst[3] < row.double_64);
    CHECK(worst[0] > 0.3 * row.float_8);
    CHECK(worst[2] > 0.3 * row.double_32);
    if (std::getenv("AIRLIGHT_TEST_FIGURES"))
      fmt::print("kind {} g {}: float 8 {:.1e}, 16 {:.1e}; double 32 {:.1e}, 64 {:.1e}\n", int(row.phase.kind),
                 row.phase.g, worst[0], worst[1], worst[2], worst[3]);
  }
}

// On vectors, any number of nodes: the same sum.
TEST_CASE("shadow planes: the sum on vectors", "[shadow_planes]") {
  const auto one = [](double, double, double) { return 1.0; };
  double worst = 0;
  for (const auto& [nodes, m] : {std::pair{1, 1}, {5, 2}, {8, 2}, {13, 3}, {16, 3}, {64, 6}})
    for (const RuleErrors& row : rule_errors()) {
      const MappedRule<double> rule(nodes, m);
      for (const auto& [a, d0, length] : rule_cases()) {
        const LitPart<double> part{0, length};
        const double expected = airlight_integral(rule, row.phase, double(a), double(-d0), 1.0, part, one);
        const double got = isotropic_integral(rule, row.phase, a, -d0, 1, part);
        worst = std::max(worst, std::abs(got - expected) / expected);
      }
    }
  CAPTURE(worst);
  CHECK(worst < 1e-13);  // rounding alone
  const MappedRule<double> rule(16, 3);
  CHECK(isotropic_integral(rule, PhaseForm{}, 1, 2, 0, {2, 3}) == infinity);  // begins at the light
}

// p(c) of both houses: 4 pi apart, and printed forms by their means.
TEST_CASE("shadow planes: phase functions have mean one", "[shadow_planes]") {
  for (const scene::PhaseFunction& p :
       {scene::PhaseFunction(scene::Isotropic{}), scene::PhaseFunction(scene::Rayleigh{}),
        scene::PhaseFunction(scene::Hazy{}), scene::PhaseFunction(scene::Murky{}),
        scene::PhaseFunction(scene::HenyeyGreenstein{0.9}), scene::PhaseFunction(scene::HenyeyGreenstein{-0.7})})
    for (double c = -1; c <= 1; c += 0.125) {
      CHECK(phase_of_halves(phase_form(p), 0.5 * (1 + c), 0.5 * (1 - c)) ==
            Approx(4 * pi * scene::phase_value(p, c)).epsilon(1e-13));
      const double mean = std::holds_alternative<scene::Hazy>(p)    ? 2
                          : std::holds_alternative<scene::Murky>(p) ? 83.0 / 33
                                                                    : 1;
      CHECK(phase_of_halves(phase_form(p, true), 0.5 * (1 + c), 0.5 * (1 - c)) ==
            Approx(mean * 4 * pi * scene::phase_value(p, c)).epsilon(1e-13));
    }
}

}  // namespace evaluators_test
