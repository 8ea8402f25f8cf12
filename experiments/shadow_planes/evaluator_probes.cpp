#include "experiments/shadow_planes/evaluator_probes.h"

#include <algorithm>
#include <cmath>

#include "experiments/shadow_planes/evaluator_errors.h"

namespace airlight::experiments::shadow_planes {
namespace {

using scene::SettingSpec;

const SettingSpec terms =
    scene::integer_setting("terms", "4", 0, 256, "degree of the polynomial, at most 12, or nodes of the rule");
const SettingSpec precision = scene::choice_setting("precision", "double", {"single", "double"}, "of all arithmetic");
const SettingSpec degree = scene::integer_setting("degree", "4", 0, 12, "of the polynomial");
const SettingSpec cases = scene::integer_setting("cases", "20000", 100, 1e7, "random ones");

SettingSpec form(std::vector<std::string> choices) {
  return scene::choice_setting("evaluator", "polynomial", std::move(choices),
                               "polynomial over the lit part, differences from the eye, or the rule");
}

Evaluator evaluator_of(const scene::Settings& s) {
  const std::string& form = s.text("evaluator");
  const int count = int(s.integer("terms"));
  if (form != "rule" && count > 12) throw Error(fmt::format("terms = {}: a degree is at most 12", count));
  if (form == "rule" && count < 1) throw Error("terms = 0: the rule needs a node");
  using Form = Evaluator::Form;
  return {form == "rule" ? Form::rule : form == "differences" ? Form::differences : Form::polynomial, count, false};
}

double share_below(const std::vector<double>& errors, double bound) {
  return double(std::count_if(errors.begin(), errors.end(), [&](double e) { return e < bound; })) /
         double(errors.size());
}

std::vector<double> decades(double from, double to, int per_decade) {
  std::vector<double> x;
  for (int i = 0; i <= int(std::lround(std::log10(to / from))) * per_decade; ++i)
    x.push_back(from * std::pow(10, double(i) / per_decade));
  return x;
}

Findings findings(const Timed& timed) {
  Findings found;
  found.figures = {exactly("median_error", timed.errors.median), exactly("p99_error", timed.errors.p99),
                   exactly("greatest_error", timed.errors.greatest)};
  set_time(found, timed.seconds);
  return found;
}

}  // namespace

std::string EvaluatorMap::about() const {
  return "greatest relative error of three lit parts over extinction and distance of the light (Biri et al. 2006, 4.1)";
}

std::vector<SettingSpec> EvaluatorMap::settings() const {
  return {form({"polynomial", "differences", "rule"}), terms, precision,
          scene::integer_setting("per_decade", "4", 1, 32, "cells along each axis")};
}

std::vector<std::string> EvaluatorMap::figures() const {
  return {"cells", "below_1e-2", "below_1e-4", "below_1e-6", "median_error", "greatest_error",
          // where the light is at most 3 optical lengths away
          "near_below_1e-2", "near_greatest_error", "reference_error"};
}

Findings EvaluatorMap::run(const ProbeInput&, const scene::Settings& settings,
                           const scene::Execution& execution) const {
  Evaluator evaluator = evaluator_of(settings);
  evaluator.single = settings.text("precision") == "single";
  const int per_decade = int(settings.integer("per_decade"));
  FigureMap map{"relative error",
                {"extinction [1/m]", decades(1e-6, 1e4, per_decade)},
                {"h [m]", decades(1e-6, 1e3, per_decade)},
                {},
                {}};
  const std::size_t columns = map.y.values.size();
  map.values.resize(map.x.values.size() * columns);
  std::vector<double> own(map.x.values.size());
  scene::parallel_for(int(map.x.values.size()), execution, [&](int i) {
    for (std::size_t k = 0; k < columns; ++k) {
      map.values[i * columns + k] = map_error(evaluator, map.x.values[i], map.y.values[k]);
      own[i] = std::max(own[i], map_reference_error(map.x.values[i], map.y.values[k]));
    }
  });
  std::vector<double> all, near;
  for (std::size_t i = 0; i < map.x.values.size(); ++i)
    for (std::size_t k = 0; k < columns; ++k) {
      const double error = map.values[i * columns + k];
      if (std::isnan(error)) continue;  // too dark for the precision
      all.push_back(error);
      if (map.x.values[i] * std::hypot(map_foot, map.y.values[k]) <= 3) near.push_back(error);
    }
  std::sort(all.begin(), all.end());
  std::sort(near.begin(), near.end());
  // a = extinction * h = 1, and the light 3 optical lengths away.
  map.lines.resize(2);
  for (const double h : map.y.values) {
    map.lines[0].push_back({1 / h, h});
    map.lines[1].push_back({3 / std::hypot(map_foot, h), h});
  }
  Findings found;
  found.figures = {exactly("cells", double(all.size())),
                   exactly("below_1e-2", share_below(all, 1e-2)),
                   exactly("below_1e-4", share_below(all, 1e-4)),
                   exactly("below_1e-6", share_below(all, 1e-6)),
                   exactly("median_error", all[all.size() / 2]),
                   exactly("greatest_error", all.back()),
                   exactly("near_below_1e-2", share_below(near, 1e-2)),
                   exactly("near_greatest_error", near.back()),
                   exactly("reference_error", *std::max_element(own.begin(), own.end()))};
  found.map = std::move(map);
  return found;
}

std::string EvaluatorAngles::about() const { return "relative error of the polynomial's integral over random angles"; }

std::vector<SettingSpec> EvaluatorAngles::settings() const {
  return {degree, scene::real_setting("reach", "0.25", 1e-3, 1.57, "angles lie within +-reach"),
          scene::real_setting("a_low", "0.3", 1e-12, 1e3, "least extinction * h"),
          scene::real_setting("a_high", "3", 1e-12, 1e3, "greatest extinction * h"), cases};
}

Findings EvaluatorAngles::run(const ProbeInput&, const scene::Settings& s, const scene::Execution&) const {
  const Spread errors = errors_over_angles(int(s.integer("degree")), s.real("reach"), s.real("a_low"), s.real("a_high"),
                                           int(s.integer("cases")));
  Findings found;
  found.figures = {exactly("median_error", errors.median), exactly("p99_error", errors.p99)};
  return found;
}

std::string EvaluatorImage::about() const {
  return "rms error over mean of the polynomial on endless rays at 0 to 90 degrees from the light";
}

std::vector<SettingSpec> EvaluatorImage::settings() const {
  return {degree, scene::real_setting("optical_distance", "1", 1e-6, 100, "of the light"),
          scene::integer_setting("rays", "90", 2, 1e6, "evenly over the angles")};
}

Findings EvaluatorImage::run(const ProbeInput&, const scene::Settings& s, const scene::Execution&) const {
  Findings found;
  found.figures = {exactly(
      "rms_error", error_over_image(int(s.integer("degree")), s.real("optical_distance"), int(s.integer("rays"))))};
  return found;
}

std::string EvaluatorTimes::about() const {
  return "error against time of one evaluation, lit parts at random, the light 0.1 to 3 optical lengths away";
}

std::vector<SettingSpec> EvaluatorTimes::settings() const {
  return {form({"polynomial", "differences", "rule"}), terms, precision, cases,
          scene::integer_setting("runs", "15", 1, 10000, "timed")};
}

Findings EvaluatorTimes::run(const ProbeInput&, const scene::Settings& s, const scene::Execution&) const {
  Evaluator evaluator = evaluator_of(s);
  evaluator.single = s.text("precision") == "single";
  return findings(errors_and_times(evaluator, int(s.integer("cases")), int(s.integer("runs"))));
}

std::vector<SettingSpec> EvaluatorTimesGpu::settings() const {
  return {form({"polynomial", "rule"}), terms, cases, scene::integer_setting("runs", "15", 1, 10000, "timed")};
}

Findings EvaluatorTimesGpu::run(const ProbeInput&, const scene::Settings& s, const scene::Execution&) const {
  return findings(
      errors_and_times(gpu::Context::get(), evaluator_of(s), int(s.integer("cases")), int(s.integer("runs"))));
}

}  // namespace airlight::experiments::shadow_planes
