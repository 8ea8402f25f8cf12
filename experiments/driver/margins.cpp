#include "experiments/driver/margins.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "experiments/driver/tables.h"

namespace airlight::experiments {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string ratio_text(double ratio) { return std::isnan(ratio) ? "-" : fmt::format("{:.3g}", ratio); }

std::string measured_text(const GateResult& gate) {
  if (!gate.measured) return "undefined";
  const Estimate& e = *gate.measured;
  return e.low < e.high ? fmt::format("{:.4g} [{:.4g}, {:.4g}]", e.value, e.low, e.high)
                        : fmt::format("{:.4g}", e.value);
}

std::string group_of(double ratio) {
  if (std::isnan(ratio)) return "6 without a ratio";
  if (std::isinf(ratio)) return "5 above a measured 0";
  return ratio <= 1.5   ? "0 up to 1.5"
         : ratio <= 3   ? "1 up to 3"
         : ratio <= 10  ? "2 up to 10"
         : ratio <= 100 ? "3 up to 100"
                        : "4 above 100";
}

}  // namespace

double margin(const GateResult& gate) {
  if (!gate.measured) return nan;
  const double measured = gate.measured->value;
  const double above = gate.upper ? gate.bound : measured, below = gate.upper ? measured : gate.bound;
  if (above == 0 && below == 0) return 1;
  if (above < 0 && below < 0) return below / above;
  if (!(below >= 0) || !(above >= 0)) return nan;
  return above / below;
}

std::string margins_text(const std::vector<GateResult>& gates) {
  std::vector<const GateResult*> order;
  for (const GateResult& gate : gates) order.push_back(&gate);
  // Gates without a ratio come last.
  const auto place = [](const GateResult& gate) { return std::isnan(margin(gate)) ? -1 : margin(gate); };
  std::stable_sort(order.begin(), order.end(),
                   [&](const GateResult* a, const GateResult* b) { return place(*a) > place(*b); });
  std::string out = fmt::format("{:>9}  {:>12}  {:34}  {:13}  gate\n", "ratio", "bound", "measured", "kind");
  std::map<std::string, int> groups;
  for (const GateResult* gate : order) {
    out += fmt::format("{:>9}  {:>12}  {:34}  {:13}  {}{}\n", ratio_text(margin(*gate)),
                       fmt::format("{} {:.4g}", gate->upper ? "<=" : ">=", gate->bound), measured_text(*gate),
                       gate->kind, gate->name, gate->passed ? "" : fmt::format(" ({})", word(*gate)));
    ++groups[group_of(margin(*gate))];
  }
  std::vector<std::string> counts;
  for (const auto& [name, count] : groups) counts.push_back(fmt::format("{}: {}", name.substr(2), count));
  return out + fmt::format("ratio of bound to measured: {}\n", fmt::join(counts, ", "));
}

std::string margins_csv(const std::vector<GateResult>& gates) {
  const auto number = [](double x) { return std::isnan(x) ? "" : fmt::format("{:.9g}", x); };
  std::string out =
      "ratio,bound_is,bound,measured,low,high,kind,result,experiment,scene,method,setting,metric,position\n";
  for (const GateResult& gate : gates) {
    const auto measured = gate.measured ? *gate.measured : Estimate{nan, nan, nan};
    std::vector<std::string> fields;
    for (const std::string& cell :
         {number(margin(gate)), std::string(gate.upper ? "at_most" : "at_least"), number(gate.bound),
          number(measured.value), number(measured.low), number(measured.high), gate.kind, std::string(word(gate)),
          gate.name.substr(0, gate.name.find(':')), gate.scene, gate.method, gate.setting, gate.metric, gate.position})
      fields.push_back(csv_field(cell));
    out += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return out;
}

}  // namespace airlight::experiments
