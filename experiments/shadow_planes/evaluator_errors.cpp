#include "experiments/shadow_planes/evaluator_errors.h"

#include <ctime>
#include <functional>
#include <limits>
#include <random>

#include "experiments/shadow_planes/light_on_ray.h"
#include "gpu/shadow_planes/evaluator_on_device.h"
#include "scene/error.h"

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

const MappedRule<double>& exact_rule() {
  static const MappedRule<double> rule(128, 6);
  return rule;
}

template <class Real, class From>
LightOnRay<Real> rounded(const LightOnRay<From>& on) {
  return {Real(on.extinction), Real(on.T), Real(on.h), Real(on.begin), Real(on.length)};
}

// Errors are those of the evaluator: it is given the numbers that the reference is given.
LightOnRay<double> single(const LightOnRay<double>& on) { return rounded<double>(rounded<float>(on)); }

template <class Real>
using Evaluator = std::function<Real(const LightOnRay<Real>&)>;

template <class Real>
Evaluator<Real> polynomial(int degree) {
  return [degree](const LightOnRay<Real>& on) { return by_polynomial(on, degree); };
}
template <class Real>
Evaluator<Real> differences(int degree) {
  return [degree](const LightOnRay<Real>& on) { return by_differences(on, degree); };
}
template <class Real>
Evaluator<Real> rule(int nodes) {
  return [rule = MappedRule<Real>(nodes, stretch_of(nodes))](const LightOnRay<Real>& on) { return by_rule(on, rule); };
}

template <class Real>
void worst(const Evaluator<Real>& evaluate, const LightOnRay<double>& on, double exact, double& error) {
  if (exact < double(std::numeric_limits<Real>::min())) return;
  const double e = std::abs(double(evaluate(rounded<Real>(on))) - exact) / exact;
  if (std::isnan(error) || !(e <= error)) error = std::isfinite(e) ? e : infinity;
}

double quantile(std::vector<double> x, double p) {
  std::sort(x.begin(), x.end());
  return x[std::min(x.size() - 1, std::size_t(p * double(x.size())))];
}

}  // namespace

const std::vector<std::string>& map_evaluators() {
  static const std::vector<std::string> titles = {"polynomial, differences, single", "polynomial, part by part, single",
                                                  "rule, 8 nodes, single",           "rule, 16 nodes, single",
                                                  "polynomial, differences, double", "polynomial, part by part, double",
                                                  "rule, 32 nodes, double",          "rule, 64 nodes, double"};
  return titles;
}

MapCell map_cell(double extinction, double h) {
  static const Evaluator<float> floats[] = {differences<float>(4), polynomial<float>(4), rule<float>(8),
                                            rule<float>(16)};
  static const Evaluator<double> doubles[] = {differences<double>(4), polynomial<double>(4), rule<double>(32),
                                              rule<double>(64)};
  static const MappedRule<double> finer(256, 6);
  MapCell cell{double(float(extinction)), double(float(h)),
               std::vector<double>(8, std::numeric_limits<double>::quiet_NaN()), 0};
  for (const auto& [begin, length] : map_parts) {
    const LightOnRay<double> on{cell.extinction, map_foot, cell.h, begin, length};
    const double exact = by_rule(on, exact_rule());
    for (int i = 0; i < 4; ++i) {
      worst(floats[i], on, exact, cell.error[i]);
      worst(doubles[i], on, exact, cell.error[4 + i]);
    }
    if (exact > std::numeric_limits<double>::min())
      cell.own_error = std::max(cell.own_error, std::abs(by_rule(on, finer) - exact) / exact);
  }
  return cell;
}

std::vector<MapCell> stability_map(int per_decade) {
  std::vector<MapCell> cells;
  for (int i = 0; i <= 10 * per_decade; ++i)
    for (int k = 0; k <= 9 * per_decade; ++k)
      cells.push_back(map_cell(std::pow(10, -6 + double(i) / per_decade), std::pow(10, -6 + double(k) / per_decade)));
  return cells;
}

std::vector<AngleRow> errors_over_angles(int cases) {
  std::vector<AngleRow> rows = {{0.25, 1e-6, 1e-2, {}}, {0.25, 0.3, 3, {}},   {0.25, 3, 30, {}},
                                {0.8, 1e-2, 0.3, {}},   {0.8, 0.3, 3, {}},    {0.8, 3, 30, {}},
                                {1.5, 1e-6, 1e-2, {}},  {1.5, 1e-2, 0.3, {}}, {1.5, 0.3, 3, {}}};
  for (AngleRow& row : rows) {
    Random random(3);
    std::vector<double> errors[angle_degrees.size()];
    for (int i = 0; i < cases; ++i) {
      const double a = log_uniform(random, row.a_low, row.a_high);
      double begin = uniform(random, -row.reach, row.reach), end = uniform(random, -row.reach, row.reach);
      if (begin > end) std::swap(begin, end);
      const double x = std::tan(begin);
      const double exact = airlight_integral(exact_rule(), airlight::shadow_planes::PhaseForm{}, a, 0.0, 1.0,
                                             airlight::shadow_planes::LitPart<double>{x, std::tan(end) - x},
                                             [](double, double, double) { return 1.0; }) *
                           std::exp(-a * (airlight::shadow_planes::q_at(x, 1.0) - 1));
      for (std::size_t d = 0; d < angle_degrees.size(); ++d)
        errors[d].push_back(std::abs(FixedPolynomial<double>(a, angle_degrees[d]).integral(begin, end) - exact) /
                            exact);
    }
    for (const auto& e : errors) row.error.push_back({quantile(e, 0.5), quantile(e, 0.99)});
  }
  return rows;
}

std::vector<ImageRow> errors_over_image(int rays) {
  std::vector<ImageRow> rows;
  for (const double depth : {0.1, 1.0, 3.0, 10.0, 30.0}) {
    ImageRow row{depth, {}};
    for (const int degree : angle_degrees) {
      double squares = 0, sum = 0;
      for (int i = 0; i < rays; ++i) {
        const double angle = 0.5 * pi * (i + 0.5) / rays;
        const LightOnRay<double> on{depth, std::cos(angle), std::sin(angle), 0, infinity};
        const double exact = by_rule(on, exact_rule()), d = by_polynomial(on, degree) - exact;
        squares += d * d;
        sum += exact;
      }
      row.error.push_back(std::sqrt(squares / rays) / (sum / rays));
    }
    rows.push_back(row);
  }
  return rows;
}

namespace {

template <class Real>
TimedRow timed(const char* name, int setting, const Evaluator<Real>& evaluate,
               const std::vector<LightOnRay<double>>& cases, const std::vector<double>& exact, int runs) {
  TimedRow row{name, sizeof(Real) == 4 ? "single" : "double", setting, 0, 0, 0, infinity};
  std::vector<LightOnRay<Real>> input;
  std::vector<double> errors;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    input.push_back(rounded<Real>(cases[i]));
    errors.push_back(std::abs(double(evaluate(input.back())) - exact[i]) / exact[i]);
  }
  row.median = quantile(errors, 0.5);
  row.p99 = quantile(errors, 0.99);
  row.greatest = quantile(errors, 1);
  for (int run = 0; run < runs; ++run) {
    // Processor time, the least of several: other programs only ever make it longer.
    const std::clock_t start = std::clock();
    Real sum = 0;
    for (const auto& on : input) sum += evaluate(on);
    if (!std::isfinite(sum)) throw Error(std::string(name) + ": a sum that is not finite");
    row.nanoseconds =
        std::min(row.nanoseconds, double(std::clock() - start) / CLOCKS_PER_SEC / double(input.size()) * 1e9);
  }
  return row;
}

// The same on a device, without the factor e^(-extinction (x0 + r0)), which the host knows.
void add_device_rows(gpu::Context& context, const std::vector<LightOnRay<double>>& cases,
                     const std::vector<double>& exact, int runs, std::vector<TimedRow>& rows) {
  using gpu::DeviceEvaluator;
  constexpr std::size_t at_once = 1 << 18;  // enough to keep a device busy
  std::vector<gpu::EvaluatorCase> input;
  while (input.size() < at_once)
    for (const LightOnRay<double>& on : cases)
      input.push_back({float(on.extinction), float(on.h), float(on.begin - on.T), float(on.length)});
  std::vector<std::pair<DeviceEvaluator, int>> evaluators;
  for (int degree = 2; degree <= 12; degree += 2) evaluators.push_back({{{}, true, degree}, degree});
  for (const int nodes : {4, 8, 16, 32, 64}) evaluators.push_back({{{}, false, nodes, stretch_of(nodes)}, nodes});
  for (const auto& [evaluator, setting] : evaluators) {
    TimedRow row{evaluator.polynomial ? "polynomial" : "rule", "single, device", setting, 0, 0, 0, infinity};
    std::vector<float> values;
    for (int run = 0; run <= runs; ++run) {  // the first one warms up
      double seconds = 0;
      values = integrals_on_device(context, evaluator, input, &seconds);
      if (run > 0) row.nanoseconds = std::min(row.nanoseconds, seconds / double(input.size()) * 1e9);
    }
    std::vector<double> errors;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const LightOnRay<double>& on = cases[i];
      const double scale =
          on.extinction / (4 * pi) * std::exp(-on.extinction * (on.begin + std::hypot(on.begin - on.T, on.h)));
      errors.push_back(std::abs(scale * values[i] - exact[i]) / exact[i]);
    }
    row.median = quantile(errors, 0.5);
    row.p99 = quantile(errors, 0.99);
    row.greatest = quantile(errors, 1);
    rows.push_back(row);
  }
}

}  // namespace

std::vector<TimedRow> errors_and_times(int count, int runs, gpu::Context* device) {
  Random random(7);
  std::vector<LightOnRay<double>> cases;
  std::vector<double> exact;
  for (int i = 0; i < count; ++i) {
    const double angle = uniform(random, 0.01, 0.5 * pi);
    cases.push_back(single({log_uniform(random, 0.1, 3), std::cos(angle), std::sin(angle), uniform(random, 0, 2),
                            uniform(random, 0.01, 2)}));
    exact.push_back(by_rule(cases.back(), exact_rule()));
  }
  std::vector<TimedRow> rows;
  const auto both = [&](const char* name, int setting, const auto& f, const auto& d) {
    rows.push_back(timed<float>(name, setting, f, cases, exact, runs));
    rows.push_back(timed<double>(name, setting, d, cases, exact, runs));
  };
  for (int degree = 2; degree <= 12; degree += 2)
    both("polynomial", degree, polynomial<float>(degree), polynomial<double>(degree));
  for (const int nodes : {4, 8, 16, 32, 64}) both("rule", nodes, rule<float>(nodes), rule<double>(nodes));
  if (device) add_device_rows(*device, cases, exact, runs, rows);
  return rows;
}

}  // namespace airlight::experiments::shadow_planes
