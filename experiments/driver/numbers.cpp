#include "experiments/driver/numbers.h"

#include "experiments/application/probes.h"
#include "experiments/driver/keeper.h"
#include "experiments/driver/plan.h"
#include "scene/base/content_key.h"
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

}  // namespace

std::string input_key(const SceneCase& c) {
  if (c.file.empty()) return "";
  if (c.file.extension() == ".toml") return scene::load_scene(c.file.string(), c.overrides).hash;
  return content_key(std::string_view(scene::read_whole_file(c.file.string(), std::size_t(1) << 30)));
}

Outcome run_numbers(Experiment experiment, const RunOptions& options) {
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
      Row row;
      row.scene = c.name;
      row.method = m.name;
      row.setting = m.setting;
      row.renderer = m.renderer;
      row.settings = settings.canonical();
      row.parameter = c.parameter;
      row.scene_hash = key;
      row.key = row_key(e, m, probe, row);
      rows.push_back({row, [&probe, &keeper, input, settings](Row known, scene::Execution execution) {
                        execution.store = &keeper.store();
                        return make_row(probe, input, settings, std::move(known), execution);
                      }});
    }
    return rows;
  });
}

}  // namespace airlight::experiments
