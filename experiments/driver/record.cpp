#include "experiments/application/build_info.h"
#include "experiments/application/json_value.h"
#include "experiments/application/machine.h"
#include "experiments/driver/expected.h"
#include "experiments/driver/tables.h"

namespace airlight::experiments {
using nlohmann::json;
namespace {

// Pictures of one scene: the reference, then the last setting of every method; of a sequence with its frame.
json pictures(const Outcome& outcome) {
  const auto entry = [&](const std::string& label, const std::string& image, const std::string& layer,
                         double exposure) {
    return json{{"label", label}, {"file", "../../images/" + image + ".exr"}, {"layer", layer}, {"exposure", exposure}};
  };
  json groups = json::array();
  for (const SceneCase& scene : outcome.experiment.scenes) {
    json list = json::array();
    for (const ReferenceInfo& reference : outcome.references)
      if (reference.scene == scene.name)
        list.push_back(
            entry("reference: " + reference.renderer, reference.image, outcome.experiment.layer, reference.exposure));
    for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
      const Row& row = outcome.rows[i];
      if (row.scene != scene.name || row.image.empty()) continue;
      const bool last = i + 1 == outcome.rows.size() || outcome.rows[i + 1].scene != row.scene ||
                        outcome.rows[i + 1].method != row.method;
      if (last)
        list.push_back(entry(row.setting.empty() ? row.method : row.method + " " + row.setting, row.image, row.layer,
                             row.exposure));
    }
    if (list.empty()) continue;
    groups.push_back({{"title", scene.name}, {"pictures", list}});
    if (!scene.of_sequence.empty())
      groups.back().update(
          {{"sequence", scene.swept_from}, {"frame", *scene.parameter}, {"frame_is", scene.of_sequence}});
  }
  return groups;
}

json references(const Outcome& outcome) {
  json list = json::array();
  for (const ReferenceInfo& r : outcome.references)
    list.push_back({{"scene", r.scene},
                    {"key", r.key},
                    {"renderer", r.renderer},
                    {"settings", r.settings},
                    {"seconds", r.seconds},
                    {"samples", r.samples},
                    {"from_cache", r.cached},
                    {"committed", r.committed},
                    {"made_by", r.program},
                    {"kept", r.kept}});
  return list;
}

json rows(const Outcome& outcome) {
  json list = json::array();
  for (const Row& row : outcome.rows) {
    list.push_back(to_json(row));
    list.back().erase("times");  // what they show is in the intervals
    for (const char* drawn : {"map", "columns", "figures_key", "made_on"})
      list.back().erase(drawn);  // with their numbers beside the plot
  }
  return list;
}

}  // namespace

json run_record(const Outcome& outcome, const std::vector<NamedTable>& tables, const std::vector<PlotFile>& plots) {
  const Experiment& e = outcome.experiment;
  const Machine machine = this_machine();
  json j = {{"experiment", e.id},
            {"title", e.title},
            {"paper", e.paper},
            {"about", e.about},
            {"profile", e.profile},
            {"complete", outcome.complete},
            {"seconds", outcome.seconds},
            {"date", utc_now()},
            {"commit", commit()},
            {"version", version()},
            {"compiler", compiler()},
            {"command", "airlight experiment run " + e.id + " --profile " + e.profile},
            {"layer", e.layer},
            {"timing", {{"runs", e.timing.runs}, {"budget_seconds", e.timing.budget}, {"threads", e.timing.threads}}},
            {"machine",
             {{"cpu", machine.cpu},
              {"threads", machine.threads},
              {"memory_gib", machine.memory_gib},
              {"simd", machine.simd},
              {"system", machine.system},
              {"load_average_at_end", machine.load_average},
              {"load_warning", load_warning(outcome)}}}};
  if (!outcome.made_on.empty())
    j["machine"] = {{"cpu", outcome.made_on}, {"threads", e.timing.threads}, {"load_warning", load_warning(outcome)}};
  if (!outcome.without_times.empty()) j["without_times"] = outcome.without_times;
  if (!e.summary.empty()) j["summary"] = summary_text(outcome);
  j["libraries"] = json::object();
  for (const auto& [name, number] : libraries()) j["libraries"][name] = number;
  j["references"] = references(outcome);
  j["tables"] = json::array();
  for (const NamedTable& table : tables) j["tables"].push_back({{"file", table.file}, {"title", table.title}});
  j["plots"] = json::array();
  for (const PlotFile& plot : plots) j["plots"].push_back({{"file", plot.file}, {"title", plot.title}});
  j["pictures"] = pictures(outcome);
  j["gates"] = json::array();
  for (const GateResult& gate : outcome.gates)
    j["gates"].push_back(
        {{"name", gate.name}, {"text", gate.text}, {"passed", gate.passed}, {"skipped", gate.skipped}});
  j["rows"] = rows(outcome);
  return j;
}

}  // namespace airlight::experiments
