// The mapped rule in single precision on the device: the table of its errors, and the polynomial.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "gpu/raster/first_hits.h"
#include "gpu/shadow_planes/evaluator.h"
#include "methods/shadow_planes/mapped_rule.h"
#include "methods/shadow_planes/polynomial.h"
#include "tests/gpu/device.h"
#include "tests/methods/shadow_planes/rule_cases.h"

namespace rule_test {

using namespace airlight;
using namespace shadow_planes_test;
using shadow_planes::LitPart;
using shadow_planes::MappedRule;

namespace {

float device_length(double length) { return length < gpu::far_away ? float(length) : gpu::far_away; }
constexpr auto one = [](auto, auto, auto) { return 1; };

}  // namespace

DEVICE_TEST_CASE("shadow planes: errors of the rule on the device", "[gpu][shadow_planes]") {
  const MappedRule<double> truth(128, 6);
  std::vector<gpu::shadow_planes::EvaluatorCase> cases;
  for (const auto& [a, d0, length] : rule_cases()) cases.push_back({a, 1, d0, device_length(length)});
  for (const RuleErrors& row : rule_errors()) {
    const std::vector<float> quick = integrals_on_device(context, {row.phase, false, 8, 2}, cases);
    const std::vector<float> fine = integrals_on_device(context, {row.phase, false, 16, 3}, cases);
    double worst_quick = 0;
    std::vector<double> errors;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const gpu::shadow_planes::EvaluatorCase& c = cases[i];
      const LitPart<double> part{0, c.length < gpu::far_away ? c.length : infinity};
      const double exact = airlight_integral(truth, row.phase, double(c.extinction), double(-c.d0), 1.0, part, one);
      REQUIRE((std::isfinite(quick[i]) && std::isfinite(fine[i])));
      worst_quick = std::max(worst_quick, std::abs(quick[i] - exact) / exact);
      errors.push_back(std::abs(fine[i] - exact) / exact);
    }
    std::sort(errors.begin(), errors.end());
    CAPTURE(int(row.phase.kind), row.phase.g, worst_quick, errors.back(), errors[errors.size() / 2]);
    // The device's exponentials and logarithms are good to some units in the last place: beside the rule's own error.
    CHECK(worst_quick < row.float_8 + 3e-6);
    CHECK(errors.back() < row.float_16 + 3e-6);
    CHECK(errors[errors.size() / 2] < 5e-7);
    CHECK(worst_quick > 0.3 * row.float_8);
    if (std::getenv("AIRLIGHT_TEST_FIGURES"))
      fmt::print("kind {} g {}: 8 nodes {:.1e}, 16 nodes {:.1e}, median {:.1e}\n", int(row.phase.kind), row.phase.g,
                 worst_quick, errors.back(), errors[errors.size() / 2]);
  }
}

// The paper's evaluator in single precision: the polynomial that double precision has, where it is of use.
DEVICE_TEST_CASE("shadow planes: the polynomial on the device", "[gpu][shadow_planes]") {
  for (const shadow_planes::PhaseForm& phase :
       {shadow_planes::PhaseForm{}, shadow_planes::PhaseForm{shadow_planes::PhaseForm::Kind::rayleigh, 0, 1}})
    for (const int degree : {2, 4, 8})
      for (const float a : {1e-4f, 0.1f, 1.0f, 3.0f})
        for (const float d0 : {-2.0f, -0.3f, 0.5f}) {
          const float got =
              gpu::shadow_planes::integrals_on_device(context, {phase, true, degree}, {{a, 1, d0, 0.7f}}).front();
          const auto c = shadow_planes::taylor_coefficients(phase, double(a), degree);
          const double theta0 = std::atan(double(d0)), theta1 = std::atan(double(d0) + double(0.7f));
          const double expected = std::exp(double(a) * (shadow_planes::q_at(double(d0), 1.0) - 1)) *
                                  shadow_planes::integrate_polynomial(c, 0, theta0, theta1);
          CAPTURE(degree, a, d0, got, expected);
          CHECK(got == Approx(expected).epsilon(2e-5));
        }
}

}  // namespace rule_test
