#include "experiments/driver/comparisons.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/driver/bootstrap.h"
#include "experiments/judging/front.h"
#include "experiments/judging/statistics.h"

namespace airlight::experiments {
namespace {

// Names of the scenes, in order of appearance.
std::vector<std::string> scene_names(const Outcome& outcome) {
  std::vector<std::string> scenes;
  for (const Row& row : outcome.rows)
    if (std::find(scenes.begin(), scenes.end(), row.scene) == scenes.end()) scenes.push_back(row.scene);
  return scenes;
}

Curve curve_rows(const Outcome& outcome, const std::string& scene, const std::string& method,
                 const std::string& metric) {
  Curve rows;
  for (const Row& row : outcome.rows)
    if (row.scene == scene && row.method == method) {
      const auto time = quantity(row, "seconds"), error = quantity(row, metric);
      const auto below = std::any_of(row.measures.begin(), row.measures.end(),
                                     [&](const Measure& m) { return m.name == metric && m.below_floor; });
      if (time && error && !below) rows.push_back(&row);
    }
  return rows;
}

std::vector<Point> points_of(const Curve& rows, const std::string& metric, const char* time = "seconds") {
  std::vector<Point> points;
  for (const Row* row : rows) points.push_back({*quantity(*row, time), *quantity(*row, metric)});
  return points;
}

// Times faster at equal error where each picture pays for its own preparation.
std::string faster_from_nothing(const Curve& baseline_rows, const Curve& other_rows, const std::string& metric) {
  const auto faster =
      speed_up(points_of(baseline_rows, metric, "total_seconds"), points_of(other_rows, metric, "total_seconds"));
  return faster ? fmt::format("{:.3g}", faster->geometric_mean) : "no common error";
}

std::string interval_text(const std::optional<Estimate>& e) {
  return e ? fmt::format("[{:.3g}, {:.3g}]", e->low, e->high) : "not known";
}

// A gain's geometric mean, for drawing it again.
Figure mean_of(std::optional<Gain> (*gain)(const std::vector<Point>&, const std::vector<Point>&)) {
  return [gain](const std::vector<Point>& baseline, const std::vector<Point>& other) {
    const auto g = gain(baseline, other);
    return g ? std::optional(g->geometric_mean) : std::nullopt;
  };
}

// Median preparation of a method's settings on a scene [s].
double preparation(const Outcome& outcome, const std::string& scene, const std::string& method) {
  std::vector<double> seconds;
  for (const Row& row : outcome.rows)
    if (row.scene == scene && row.method == method && row.runs > 0) seconds.push_back(row.prepare_seconds);
  return median(seconds);
}

// How many renders pay for a longer preparation, in the middle of the common errors.
std::string break_even(const Outcome& outcome, const SpeedUpCase& s, const std::string& scene,
                       const std::vector<Point>& baseline, const std::vector<Point>& other, const Gain& faster) {
  const double error = std::sqrt(faster.from * faster.to);
  const double saved = *time_at_error(baseline, error) - *time_at_error(other, error);
  const double longer = preparation(outcome, scene, s.method) - preparation(outcome, scene, s.baseline);
  if (longer <= 0) return saved >= 0 ? "1" : "never";
  return saved > 0 ? fmt::format("{:.0f}", std::ceil(longer / saved)) : "never";
}

// Why there is no equal error: in which direction, and at what time.
std::string no_common_error(const SpeedUpCase& s, const std::vector<Point>& baseline, const std::vector<Point>& other) {
  if (const auto ratio = speed_up_of_exact(baseline, other)) return fmt::format("{:.3g}, both with error 0", *ratio);
  const auto apart = apart_in_error(baseline, other);
  if (!apart) return "no common error";
  const std::string &close = apart->other_is_closer ? s.method : s.baseline,
                    &far = apart->other_is_closer ? s.baseline : s.method;
  return fmt::format(
      "none: even the fastest of {} has a smaller error ({:.2g}) than the closest of {} ({:.2g}), in {:.3g} times its "
      "time; its slowest takes {:.3g} times as long as the fastest of {}",
      close, apart->error, far, apart->least_error, apart->fastest_to_closest, apart->slowest_to_fastest, far);
}

}  // namespace

TextTable equal_error_and_time(const Outcome& outcome) {
  TextTable lines{{"scene", "method", "against", "metric", "times faster at equal error", "95 % interval", "range",
                   "over errors", "times faster with preparation", "preparation repaid after renders",
                   "times less error at equal time", "95 % interval", "range", "over times"}};
  for (const SpeedUpCase& s : outcome.experiment.speed_ups)
    for (const std::string& scene : scene_names(outcome)) {
      const Curve baseline_rows = curve_rows(outcome, scene, s.baseline, s.metric),
                  other_rows = curve_rows(outcome, scene, s.method, s.metric);
      const auto baseline = points_of(baseline_rows, s.metric), other = points_of(other_rows, s.metric);
      if (baseline.empty() || other.empty()) continue;
      std::vector<std::string> line{scene, s.method, s.baseline, s.metric};
      if (const auto faster = speed_up(baseline, other))
        line.insert(line.end(), {fmt::format("{:.3g}", faster->geometric_mean),
                                 interval_text(bootstrap(baseline_rows, other_rows, s.metric, mean_of(speed_up))),
                                 fmt::format("{:.3g} to {:.3g}", faster->least, faster->greatest),
                                 fmt::format("{:.2g} to {:.2g}", faster->from, faster->to),
                                 faster_from_nothing(baseline_rows, other_rows, s.metric),
                                 break_even(outcome, s, scene, baseline, other, *faster)});
      else
        line.insert(line.end(), {no_common_error(s, baseline, other), "", "", "",
                                 faster_from_nothing(baseline_rows, other_rows, s.metric), ""});
      if (const auto better = error_ratio(baseline, other))
        line.insert(line.end(), {fmt::format("{:.3g}", better->geometric_mean),
                                 interval_text(bootstrap(baseline_rows, other_rows, s.metric, mean_of(error_ratio))),
                                 fmt::format("{:.3g} to {:.3g}", better->least, better->greatest),
                                 fmt::format("{} to {}", duration(better->from), duration(better->to))});
      else
        line.insert(line.end(), {"no common time", "", "", ""});
      lines.push_back(line);
    }
  return lines;
}

std::optional<Estimate> speed_up_at_equal_error(const Outcome& outcome, const SpeedUpCase& s,
                                                const std::string& scene) {
  const Curve baseline_rows = curve_rows(outcome, scene, s.baseline, s.metric),
              other_rows = curve_rows(outcome, scene, s.method, s.metric);
  const auto baseline = points_of(baseline_rows, s.metric), other = points_of(other_rows, s.metric);
  if (baseline.empty() || other.empty()) return std::nullopt;
  if (const auto faster = speed_up(baseline, other)) {
    const double mean = faster->geometric_mean;
    return bootstrap(baseline_rows, other_rows, s.metric, mean_of(speed_up)).value_or(Estimate{mean, mean, mean});
  }
  const auto exact = speed_up_of_exact(baseline, other);
  return exact ? std::optional(Estimate{*exact, *exact, *exact}) : std::nullopt;
}

std::optional<double> least_speed_up(const Outcome& outcome, const SpeedUpCase& s, const std::string& scene) {
  const auto apart = apart_in_error(points_of(curve_rows(outcome, scene, s.baseline, s.metric), s.metric),
                                    points_of(curve_rows(outcome, scene, s.method, s.metric), s.metric));
  return apart && apart->other_is_closer ? std::optional(1 / apart->fastest_to_closest) : std::nullopt;
}

TextTable orders(const Outcome& outcome) {
  TextTable lines{{"scene", "method", "metric", "settings", "orders"}};
  for (const std::string& scene : scene_names(outcome))
    for (const std::string& metric : outcome.experiment.metrics) {
      if (metric.find(".rel_l2") == std::string::npos && metric.find(".greatest") == std::string::npos) continue;
      std::map<std::string, std::map<double, double>> errors;  // by method and setting
      for (const Row& row : outcome.rows) {
        const auto setting = quantity(row, "setting"), error = quantity(row, metric);
        if (row.scene == scene && setting && error && setting->value > 0 && error->value > 0)
          errors[row.method][setting->value] = error->value;
      }
      for (const auto& [method, curve] : errors) {
        if (curve.size() < 2) continue;
        std::vector<std::string> settings, found;
        for (auto last = curve.begin(), next = std::next(last); next != curve.end(); last = next++)
          found.push_back(
              fmt::format("{:.2f}", std::log(last->second / next->second) / std::log(next->first / last->first)));
        for (const auto& [setting, error] : curve) settings.push_back(fmt::format("{:g}", setting));
        lines.push_back({scene, method, metric, fmt::format("{}", fmt::join(settings, ", ")),
                         fmt::format("{}", fmt::join(found, ", "))});
      }
    }
  return lines;
}

std::vector<bool> on_front(const Outcome& outcome) {
  std::vector<bool> marks(outcome.rows.size(), false);
  const auto& metrics = outcome.experiment.metrics;
  if (metrics.empty()) return marks;
  for (const std::string& scene : scene_names(outcome)) {
    std::vector<Point> points;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
      const Row& row = outcome.rows[i];
      const auto time = quantity(row, "seconds"), error = quantity(row, metrics.front());
      if (row.scene != scene || !time || !error) continue;
      points.push_back({*time, *error});
      index.push_back(i);
    }
    for (const std::size_t kept : front(points)) marks[index[kept]] = true;
  }
  return marks;
}

std::string load_warning(const Outcome& outcome) {
  std::size_t loaded = 0, timed = 0;
  const Row* worst = nullptr;
  for (const Row& row : outcome.rows) {
    if (row.times.empty()) continue;
    ++timed;
    if (row.waited > much_waiting) ++loaded;
    if (!worst || row.waited > worst->waited) worst = &row;
  }
  if (loaded == 0) return "";
  return fmt::format(
      "Times are disturbed: in {} of {} timed rows threads waited for a processor for more than {:.0f} % of their time "
      "({}, {}{}: {:.0f} %)",
      loaded, timed, 100 * much_waiting, worst->scene, worst->method,
      worst->setting.empty() ? "" : " " + worst->setting, 100 * worst->waited);
}

std::string time_text(const Row& row) {
  if (row.runs == 0) return "";
  if (row.runs == 1) return duration(row.seconds.value) + " (1 run)";
  return fmt::format("{} [{}, {}]", duration(row.seconds.value), duration(row.seconds.low), duration(row.seconds.high));
}

std::string duration(double seconds) {
  if (seconds < 1e-6) return fmt::format("{:.3g} ns", 1e9 * seconds);
  if (seconds < 1e-3) return fmt::format("{:.3g} us", 1e6 * seconds);
  if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return fmt::format("{:.3g} s", seconds);
}

}  // namespace airlight::experiments
