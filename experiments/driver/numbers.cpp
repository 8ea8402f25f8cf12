#include "experiments/driver/numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/application/probes.h"
#include "experiments/driver/comparisons.h"
#include "experiments/driver/keeper.h"
#include "experiments/driver/plan.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/read_file.h"

namespace airlight::experiments {
namespace {

MadeRow make_row(const Probe& probe, const ProbeInput& input, const scene::Settings& settings, Row row,
                 const scene::Execution& execution) {
  Findings found = probe.run(input, settings, execution);
  row.device = probe.device();
  row.measures = std::move(found.figures);
  row.note = std::move(found.note);
  row.counters = std::move(found.counters);
  row.seconds = found.seconds;
  row.coverage = found.coverage;
  row.runs = found.runs;
  row.map = std::move(found.map);
  row.columns = std::move(found.columns);
  return {std::move(row), 0, {}};
}

// Content of the file of a [[scene]]: of a scene file the scene's hash. Throws Error for one that is no good.
std::string input_key(const SceneCase& c) {
  if (c.file.empty()) return "";
  if (c.file.extension() == ".toml") return scene::load_scene(c.file.string(), c.overrides).hash;
  return content_key(std::string_view(scene::read_whole_file(c.file.string(), std::size_t(1) << 30)));
}

}  // namespace

const scene::Component& Numbers::find_component(const std::string& name, const std::string& position) const {
  return find_probe(name, position);
}

void Numbers::check_metrics(Experiment& e, const std::string& position) const {
  std::vector<std::string> known;
  for (const MethodCase& m : e.methods)
    for (const std::string& figure : find_probe(m.renderer, m.name).figures())
      if (std::find(known.begin(), known.end(), figure) == known.end()) known.push_back(figure);
  for (const std::string& metric : e.metrics)
    if (std::find(known.begin(), known.end(), metric) == known.end())
      throw Error(fmt::format("{}: unknown figure '{}', expected one of {}{}", position, metric, fmt::join(known, ", "),
                              scene::nearest_hint(metric, known)));
}

bool Numbers::is_speed(const Row& row, const std::string& metric) const {
  return experiments::is_speed(find_probe(row.renderer, row.method), metric);
}

std::vector<RowColumn> Numbers::time_columns() const { return {{"time of one", time_text}}; }

std::string Numbers::conditions() const {
  return "Figures with [95 % interval by ranks] where they are medians of several runs.";
}

void Numbers::check(const Experiment& e, const RunOptions&) const {
  for (const SceneCase& c : e.scenes) input_key(c);
}

Outcome Numbers::run(Experiment experiment, const RunOptions& options) const {
  RowKeeper keeper(std::move(experiment), options);
  const Experiment& e = keeper.experiment();
  return keeper.run([&](const SceneCase& c) {
    const std::string key = input_key(c);
    const ProbeInput input{c.file, c.overrides, e.profile == "quick"};
    std::vector<RowPlan> rows;
    for (const MethodCase& m : e.methods) {
      if (!is_on(m, c)) continue;
      const Probe& probe = find_probe(m.renderer, m.name);
      const scene::Settings settings(probe.settings(), m.settings, m.name);
      Row row = row_of(c, m, settings, key);
      set_keys(e, m, probe, row);
      rows.push_back({row, [&probe, &keeper, input, settings](Row known, scene::Execution execution) {
                        execution.store = &keeper.store();
                        return make_row(probe, input, settings, std::move(known), execution);
                      }});
    }
    return rows;
  });
}

}  // namespace airlight::experiments
