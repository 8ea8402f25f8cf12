#include <fmt/format.h>

#include <cmath>
#include <set>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {
namespace {

std::string figure(const Row& row, const std::string& metric) {
  for (const Measure& m : row.measures)
    if (m.name == metric) return text(m);
  if (const auto e = quantity(row, metric)) return fmt::format("{:.4g} [{:.4g}, {:.4g}]", e->value, e->low, e->high);
  return row.note.empty() ? "undefined" : row.note;
}

std::string name_of(const Experiment& experiment, const GateCase& gate, const Row& row) {
  return fmt::format("{}: {}{}{}: {}", experiment.id, row.scene.empty() ? "" : row.scene + ", ", row.method,
                     row.setting.empty() ? "" : " " + row.setting, gate.metric);
}

std::string kind_of(const Row& row, const std::string& metric) {
  if (judges_time(metric)) return "time";
  if (metric.rfind("counter.", 0) == 0) return "counter";
  for (const char* test : {"objections", "largest_z", "detectable_bias"})
    if (metric == test) return "Monte Carlo";  // of equality but for noise
  for (const Measure& m : row.measures)
    if (m.name == metric && (m.floor > 0 || m.low < m.high)) return "Monte Carlo";
  return "deterministic";
}

GateResult judge(const Experiment& experiment, const GateCase& gate, const Row& row) {
  const bool upper = std::isfinite(gate.at_most);
  const double bound = upper ? gate.at_most : gate.at_least;
  const auto e = quantity(row, gate.metric);
  GateResult result;
  result.scene = row.scene;
  result.method = row.method;
  result.setting = row.setting;
  result.seconds = row.prepare_seconds + row.seconds.value;
  result.metric = gate.metric;
  result.position = gate.position;
  result.kind = kind_of(row, gate.metric);
  result.upper = upper;
  result.bound = bound;
  result.measured = e;
  result.skipped = row.unavailable;
  result.passed = e && (upper ? e->low <= bound : e->high >= bound);
  result.name = name_of(experiment, gate, row);
  result.text = fmt::format("{} {} {:g}{} {}", result.name, upper ? "<=" : ">=", bound,
                            result.skipped  ? " is skipped:"
                            : result.passed ? ":"
                                            : " fails:",
                            figure(row, gate.metric));
  if (!gate.why.empty()) result.text += fmt::format(" ({})", gate.why);
  return result;
}

// A figure that a gate covers and that nothing bounds: new, or measured on another device.
GateResult unbounded(const Experiment& experiment, const GateCase& gate, const Row& row, bool other_device) {
  GateResult result;
  result.name = name_of(experiment, gate, row);
  result.skipped = other_device;
  result.text = result.name + (other_device ? " is skipped: its bound was measured on another device: "
                                            : " fails: it has no bound; scripts/tighten gives it one: ");
  result.text += figure(row, gate.metric);
  return result;
}

}  // namespace

GateCounts count(const std::vector<GateResult>& gates) {
  GateCounts counts;
  for (const GateResult& gate : gates) ++(gate.skipped ? counts.skipped : gate.passed ? counts.passed : counts.failed);
  return counts;
}

const char* word(const GateResult& gate) { return gate.skipped ? "skipped" : gate.passed ? "ok" : "FAILED"; }

bool judges_time(const std::string& metric) { return metric.ends_with("seconds") && !metric.starts_with("counter."); }

std::vector<GateResult> judge(const Experiment& experiment, const std::vector<Row>& rows) {
  std::vector<GateResult> results;
  std::set<std::pair<const Row*, std::string>> held;   // row and metric have a bound by row,
  std::set<std::pair<const Row*, std::string>> apart;  // one that was measured on another device
  for (const GateCase& gate : experiment.gates) {
    bool any = false;
    for (const Row& row : rows) {
      if (!judges(gate, row.scene, row.method, row.setting)) continue;
      any = true;
      const auto figure = std::make_pair(&row, gate.metric);
      if (gate.by_row) {
        const bool same = row.unavailable || row.device == gate.device;
        (same ? held : apart).insert(figure);
        if (same) results.push_back(judge(experiment, gate, row));
      } else if (!held.count(figure)) {
        if (std::isfinite(gate.at_most) || std::isfinite(gate.at_least))
          results.push_back(judge(experiment, gate, row));
        else if (quantity(row, gate.metric))
          results.push_back(unbounded(experiment, gate, row, apart.count(figure)));
      }
    }
    if (!any) {
      const std::string name = fmt::format("{}: {}, {} {}: {}", experiment.id, gate.scene.empty() ? "any" : gate.scene,
                                           gate.method, gate.setting, gate.metric);
      results.push_back({name, name + " fails: there is no such row"});
    }
  }
  return results;
}

}  // namespace airlight::experiments
