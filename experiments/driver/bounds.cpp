#include "experiments/driver/bounds.h"

#include <fmt/format.h>

#include <cmath>

#include "experiments/driver/tables.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"

namespace airlight::experiments {
namespace {

const std::string header = "scene,method,setting,metric,device,measured,at_least,at_most";

double number(const std::string& text, double fallback, const std::string& where) {
  if (text.empty()) return fallback;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != 0 || !std::isfinite(value)) throw Error(fmt::format("{}: '{}', expected a number", where, text));
  return value;
}

// The gate of the experiment's file that covers the line: it says why, and whether there is one at all.
const GateCase& covering(const Experiment& e, const GateCase& line, const std::string& where) {
  for (const GateCase& gate : e.gates)
    if (!gate.by_row && gate.metric == line.metric && judges(gate, line.scene, line.method, line.setting)) return gate;
  throw Error(
      fmt::format("{}: no [[gate]] covers {}, {} {}: {}", where, line.scene, line.method, line.setting, line.metric));
}

void add_line(const Experiment& e, std::vector<GateCase>& gates, const std::string& line, const std::string& where) {
  const auto field = csv_fields(line, where);
  if (field.size() != 8) throw Error(fmt::format("{}: {} fields, expected {}", where, field.size(), header));
  GateCase gate;
  gate.by_row = true;
  gate.position = where;
  gate.scene = field[0];
  gate.method = field[1];
  gate.setting = field[2];
  gate.metric = field[3];
  gate.device = field[4];
  const double least = number(field[6], -infinity, where), most = number(field[7], infinity, where);
  if (!std::isfinite(least) && !std::isfinite(most)) throw Error(where + ": neither at_least nor at_most");
  const std::string why = covering(e, gate, where).why;
  gate.why = fmt::format("{}{}measured {}", why, why.empty() ? "" : "; ", field[5]);
  if (std::isfinite(most)) {
    gates.push_back(gate);
    gates.back().at_most = most;
  }
  if (std::isfinite(least)) {
    gates.push_back(gate);
    gates.back().at_least = least;
  }
}

}  // namespace

void add_bounds(Experiment& e, const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  std::vector<GateCase> gates;
  const std::string text = scene::read_whole_file(file.string());
  int number = 0;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin), where = fmt::format("{}:{}", file.string(), number + 1);
    begin = end + 1;
    if (number > 0) add_line(e, gates, line, where);
    if (number == 0 && line != header) throw Error(fmt::format("{}: '{}', expected {}", where, line, header));
  }
  e.gates.insert(e.gates.begin(), gates.begin(), gates.end());
}

}  // namespace airlight::experiments
