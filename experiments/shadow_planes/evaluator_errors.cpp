#include "experiments/shadow_planes/evaluator_errors.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <limits>
#include <random>

#include "experiments/shadow_planes/light_on_ray.h"
#include "gpu/shadow_planes/evaluator.h"
#include "scene/base/error.h"

namespace airlight::experiments::shadow_planes {
namespace {

using airlight::shadow_planes::MappedRule;
using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
double log_uniform(Random& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

double exact_value(const LightOnRay<double>& on) {
  static const MappedRule<double> rule(128, 6);
  return by_rule(on, rule);
}

template <class Real, class From>
LightOnRay<Real> rounded(const LightOnRay<From>& on) {
  return {Real(on.extinction), Real(on.T), Real(on.h), Real(on.begin), Real(on.length)};
}

template <class Real>
std::function<Real(const LightOnRay<Real>&)> function_of(const Evaluator& e) {
  if (e.form == Evaluator::Form::polynomial)
    return [degree = e.terms](const LightOnRay<Real>& on) { return by_polynomial(on, degree); };
  if (e.form == Evaluator::Form::differences)
    return [degree = e.terms](const LightOnRay<Real>& on) { return by_differences(on, degree); };
  return
      [rule = MappedRule<Real>(e.terms, stretch_of(e.terms))](const LightOnRay<Real>& on) { return by_rule(on, rule); };
}

std::function<double(const LightOnRay<double>&)> value_of(const Evaluator& e) {
  if (!e.single) return function_of<double>(e);
  return [f = function_of<float>(e)](const LightOnRay<double>& on) { return double(f(rounded<float>(on))); };
}

Spread spread_of(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double p) { return errors[std::min(errors.size() - 1, std::size_t(p * double(errors.size())))]; };
  return {at(0.5), at(0.99), errors.back()};
}

// Errors are those of the evaluator: it is given the numbers that the reference is given.
LightOnRay<double> on_map(double extinction, double h, const std::array<double, 2>& part) {
  return rounded<double>(rounded<float>(LightOnRay<double>{extinction, map_foot, h, part[0], part[1]}));
}

std::vector<LightOnRay<double>> random_parts(int count) {
  Random random(7);
  std::vector<LightOnRay<double>> parts;
  for (int i = 0; i < count; ++i) {
    const double angle = uniform(random, 0.01, 0.5 * pi);
    const LightOnRay<double> on{log_uniform(random, 0.1, 3), std::cos(angle), std::sin(angle), uniform(random, 0, 2),
                                uniform(random, 0.01, 2)};
    parts.push_back(rounded<double>(rounded<float>(on)));
  }
  return parts;
}

// Processor time: other programs only ever make it longer.
template <class Real>
std::vector<double> times_of(const Evaluator& e, const std::vector<LightOnRay<double>>& parts, int runs) {
  const auto evaluate = function_of<Real>(e);
  std::vector<LightOnRay<Real>> input;
  for (const auto& on : parts) input.push_back(rounded<Real>(on));
  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    const std::clock_t start = std::clock();
    Real sum = 0;
    for (const auto& on : input) sum += evaluate(on);
    if (!std::isfinite(sum)) throw Error("a sum of the evaluator that is not finite");
    seconds.push_back(double(std::clock() - start) / CLOCKS_PER_SEC / double(input.size()));
  }
  return seconds;
}

}  // namespace

double map_error(const Evaluator& e, double extinction, double h) {
  const auto value = value_of(e);
  const double least =
      e.single ? double(std::numeric_limits<float>::min()) : std::numeric_limits<double>::min();  // that is normal
  double worst = std::numeric_limits<double>::quiet_NaN();
  for (const auto& part : map_parts) {
    const LightOnRay<double> on = on_map(extinction, h, part);
    const double exact = exact_value(on);
    if (exact < least) continue;
    const double error = std::abs(value(on) - exact) / exact;
    if (std::isnan(worst) || !(error <= worst)) worst = std::isfinite(error) ? error : infinity;
  }
  return worst;
}

double map_reference_error(double extinction, double h) {
  static const MappedRule<double> finer(256, 6);
  double worst = 0;
  for (const auto& part : map_parts) {
    const LightOnRay<double> on = on_map(extinction, h, part);
    const double exact = exact_value(on);
    if (exact > std::numeric_limits<double>::min())
      worst = std::max(worst, std::abs(by_rule(on, finer) - exact) / exact);
  }
  return worst;
}

Spread errors_over_angles(int degree, double reach, double a_low, double a_high, int cases) {
  static const MappedRule<double> rule(128, 6);
  Random random(3);
  std::vector<double> errors;
  for (int i = 0; i < cases; ++i) {
    const double a = log_uniform(random, a_low, a_high);
    double begin = uniform(random, -reach, reach), end = uniform(random, -reach, reach);
    if (begin > end) std::swap(begin, end);
    const double x = std::tan(begin);
    const double exact = airlight_integral(rule, airlight::shadow_planes::PhaseForm{}, a, 0.0, 1.0,
                                           airlight::shadow_planes::LitPart<double>{x, std::tan(end) - x},
                                           [](double, double, double) { return 1.0; }) *
                         std::exp(-a * (airlight::shadow_planes::q_at(x, 1.0) - 1));
    errors.push_back(std::abs(FixedPolynomial<double>(a, degree).integral(begin, end) - exact) / exact);
  }
  return spread_of(errors);
}

double error_over_image(int degree, double optical_distance, int rays) {
  double squares = 0, sum = 0;
  for (int i = 0; i < rays; ++i) {
    const double angle = 0.5 * pi * (i + 0.5) / rays;
    const LightOnRay<double> on{optical_distance, std::cos(angle), std::sin(angle), 0, infinity};
    const double exact = exact_value(on), d = by_polynomial(on, degree) - exact;
    squares += d * d;
    sum += exact;
  }
  return std::sqrt(squares / rays) / (sum / rays);
}

Timed errors_and_times(const Evaluator& e, int cases, int runs) {
  const auto parts = random_parts(cases);
  const auto value = value_of(e);
  std::vector<double> errors;
  for (const auto& on : parts) {
    const double exact = exact_value(on);
    errors.push_back(std::abs(value(on) - exact) / exact);
  }
  return {spread_of(errors), e.single ? times_of<float>(e, parts, runs) : times_of<double>(e, parts, runs)};
}

Timed errors_and_times(gpu::Context& context, const Evaluator& e, int cases, int runs) {
  constexpr std::size_t at_once = 1 << 18;  // enough to keep a device busy
  const auto parts = random_parts(cases);
  const bool polynomial = e.form == Evaluator::Form::polynomial;
  const gpu::shadow_planes::DeviceEvaluator evaluator{{}, polynomial, e.terms, polynomial ? 3 : stretch_of(e.terms)};
  std::vector<gpu::shadow_planes::EvaluatorCase> input;
  while (input.size() < at_once)
    for (const auto& on : parts)
      input.push_back({float(on.extinction), float(on.h), float(on.begin - on.T), float(on.length)});
  Timed result;
  std::vector<float> values;
  for (int run = 0; run <= runs; ++run) {  // the first one warms up
    double seconds = 0;
    values = integrals_on_device(context, evaluator, input, &seconds);
    if (run > 0) result.seconds.push_back(seconds / double(input.size()));
  }
  std::vector<double> errors;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    // The device leaves out the factor e^(-extinction (x0 + r0)), which the host knows.
    const LightOnRay<double>& on = parts[i];
    const double scale =
        on.extinction / (4 * pi) * std::exp(-on.extinction * (on.begin + std::hypot(on.begin - on.T, on.h)));
    const double exact = exact_value(on);
    errors.push_back(std::abs(scale * values[i] - exact) / exact);
  }
  result.errors = spread_of(errors);
  return result;
}

}  // namespace airlight::experiments::shadow_planes
