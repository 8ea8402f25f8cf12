#include "experiments/driver/expected.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "experiments/application/probes.h"
#include "experiments/driver/kind.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr const char* not_available = "not available";

struct Found {
  Estimate figure;
  bool below_floor = false;  // nothing is known but figure.high
  const Row* row = nullptr;  // null: read off several
  bool at_least = false;     // it may be greater
};

std::optional<Found> find_figure(const Outcome& outcome, const ExpectedCase& e) {
  if (e.method.empty()) return std::nullopt;
  if (!e.baseline.empty()) {
    const SpeedUpCase both{e.baseline, e.method, e.metric};
    if (const auto ratio = speed_up_at_equal_error(outcome, both, e.scene)) return Found{*ratio};
    const auto least = least_speed_up(outcome, both, e.scene);
    return least ? std::optional(Found{{*least, *least, *least}, false, nullptr, true}) : std::nullopt;
  }
  for (const Row& row : outcome.rows) {
    if (row.scene != e.scene || row.method != e.method || (!e.setting.empty() && row.setting != e.setting)) continue;
    const auto figure = quantity(row, e.metric);
    if (!figure) continue;
    const bool below = std::any_of(row.measures.begin(), row.measures.end(),
                                   [&](const Measure& m) { return m.name == e.metric && m.below_floor; });
    return Found{*figure, below, &row};
  }
  return std::nullopt;
}

// Unit of the figure: s, ms, ns, percent; "share" of 1; "times", a ratio; empty for all else.
std::string own_unit(const ExpectedCase& e) {
  if (!e.baseline.empty()) return "times";
  const std::string& metric = e.metric;
  if (metric.starts_with("counter.")) return "";
  if (has_word(metric, "seconds")) return "s";
  for (const char* unit : {"ms", "ns", "percent"})
    if (has_word(metric, unit)) return unit;
  for (const char* relative : {"rel_l2", "bias", "p95", "p99", "p999", "wrong", "rmse_range", "drift"})
    if (metric.find(relative) != std::string::npos && metric.find("squared") == std::string::npos) return "share";
  return "";
}

std::optional<double> seconds_in(const std::string& unit) {
  for (const auto& [name, seconds] : {std::pair("s", 1.0), {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}})
    if (unit == name) return seconds;
  return std::nullopt;
}

std::string two_digits(double x) {
  if (x == 0 || !std::isfinite(x)) return fmt::format("{:g}", x);
  const double rounded = std::stod(fmt::format("{:.1e}", x));
  const int first = int(std::floor(std::log10(std::abs(rounded)) + 1e-9));  // its power of ten
  return first < -5 ? fmt::format("{:.1e}", x) : fmt::format("{:.{}f}", rounded, std::max(0, 1 - first));
}

std::string in_unit(double x, const ExpectedCase& e) {
  const std::string own = own_unit(e);
  std::string unit = e.unit.empty() ? own : e.unit;
  if (const auto own_seconds = seconds_in(own)) {
    const double seconds = x * *own_seconds;
    if (unit == "per second") return two_digits(1 / seconds) + " per second";
    if (e.unit.empty() && own == "s") unit = seconds < 1e-6 ? "ns" : seconds < 1e-3 ? "us" : seconds < 1 ? "ms" : "s";
    return fmt::format("{} {}", two_digits(seconds / *seconds_in(unit)), unit);
  }
  if (unit == "share" || (unit == "percent" && own != "percent")) return two_digits(100 * x) + " %";
  if (unit == "percent") return two_digits(x) + " %";
  if (unit == "times") return two_digits(x) + " times";
  return std::abs(x) < 1000 ? fmt::format("{:.3g}", x) : fmt::format("{:.0f}", x);
}

// [s] Of a row of pictures with the film that the time is of.
std::string time_and_film(const Outcome& outcome, const Row& row) {
  const std::string time = time_text(row);
  return outcome.experiment.kind->draws_pictures()
             ? fmt::format("{} at {}x{}, {:.3g} per second", time, row.width, row.height, 1 / row.seconds.value)
             : time;
}

std::string ours(const Outcome& outcome, const ExpectedCase& e) {
  if (e.method.empty()) return "";
  if (const auto found = find_figure(outcome, e)) {
    const Estimate& f = found->figure;
    if (found->row && !found->row->note.empty()) return found->row->note;
    if (e.unit.empty() && found->row) {
      if (e.metric == "seconds") return time_and_film(outcome, *found->row);
      for (const Measure& m : found->row->measures)
        if (m.name == e.metric) return text(m);
    }
    if (found->below_floor) return figure_text(outcome, e);
    if (found->at_least) return figure_text(outcome, e);
    std::string out = in_unit(f.value, e);
    if (f.low < f.high) out += fmt::format(" [{}, {}]", in_unit(f.low, e), in_unit(f.high, e));
    const bool film = found->row && e.metric == "seconds" && outcome.experiment.kind->draws_pictures();
    return film ? fmt::format("{} at {}x{}", out, found->row->width, found->row->height) : out;
  }
  for (const Row& row : outcome.rows)
    if (row.scene == e.scene && row.method == e.method && (e.setting.empty() || row.setting == e.setting))
      return row.note.empty() ? "not defined" : row.note;
  return "not in this profile";
}

}  // namespace

std::vector<std::string> expected_units() { return {"percent", "times", "s", "ms", "us", "ns", "per second"}; }

bool fits_unit(const ExpectedCase& e) {
  const std::string own = own_unit(e);
  const bool of_time = seconds_in(e.unit) || e.unit == "per second";
  if (seconds_in(own)) return of_time;
  return !of_time && !(own == "percent" && e.unit == "times") && !(own == "times" && e.unit == "percent");
}

std::string figure_text(const Outcome& outcome, const ExpectedCase& e) {
  const auto found = find_figure(outcome, e);
  if (!found) return not_available;
  if (found->below_floor) return "at most " + in_unit(found->figure.high, e);
  return (found->at_least ? "at least " : "") + in_unit(found->figure.value, e);
}

TextTable expected_table(const Outcome& outcome) {
  TextTable lines{{"what", "printed", "ours"}};
  for (const ExpectedCase& e : outcome.experiment.expected) lines.push_back({e.what, e.paper, ours(outcome, e)});
  return lines;
}

std::string fill_in(const std::string& text, const std::function<std::string(std::size_t)>& figure) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find_first_of("{}", at);
    out += text.substr(at, open - at);
    if (open == std::string::npos) break;
    if (text[open] == '}') throw Error("found '}' without '{', expected {1}, {2}, ...");
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) throw Error("found '{' without '}', expected {1}, {2}, ...");
    const std::string between = text.substr(open + 1, close - open - 1);
    std::size_t number = 0;
    const auto [end, code] = std::from_chars(between.data(), between.data() + between.size(), number);
    if (code != std::errc() || end != between.data() + between.size())
      throw Error(fmt::format("found '{{{}}}', expected {{1}}, {{2}}, ...", between));
    out += figure(number);
    at = close + 1;
  }
  return out;
}

std::string summary_text(const Outcome& outcome) {
  const Experiment& e = outcome.experiment;
  return fill_in(e.summary, [&](std::size_t n) { return figure_text(outcome, e.expected.at(n - 1)); });
}

}  // namespace airlight::experiments
