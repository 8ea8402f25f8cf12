// table.md: what a run shows, from its record and its tables.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "experiments/application/json_value.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/row.h"
#include "experiments/driver/tables.h"

namespace airlight::experiments {
using nlohmann::json;
namespace {

std::string markdown(const TextTable& lines) {
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += fmt::format("| {} |\n", fmt::join(lines[i], " | "));
    if (i == 0) out += fmt::format("|{}|\n", fmt::join(std::vector<std::string>(lines[0].size(), "---"), "|"));
  }
  return out;
}

// One sentence below the heading of a table whose numbers need it.
std::string explanation(const std::string& file) {
  if (file == "stages.csv") return "Median time of each stage. A blank: the row does not have this stage.\n\n";
  if (file == "orders.csv") return "Order with which the error falls from each setting to the next.\n\n";
  return "";
}

// A conclusion or verdict is checked on one table, often that of profile quick: the page of another table names it.
std::string checked_on(const Experiment& e, const std::string& table, const char* before, const char* after) {
  return table == results_name(e.id, e.profile) ? "" : fmt::format("{} the table `{}`{}", before, table, after);
}

std::vector<GateResult> gates_of(const json& record) {
  std::vector<GateResult> gates;
  for (const json& gate : record.at("gates"))
    gates.push_back({gate.at("name"), gate.at("text"), gate.at("passed"), gate.at("skipped")});
  return gates;
}

// The summary, the conclusion, and the verdicts on claims of the paper.
std::string conclusion(const Experiment& e, const json& record) {
  std::string out = record.contains("summary") ? record.at("summary").get<std::string>() + "\n\n" : "";
  if (e.conclusion) out += e.conclusion->text + checked_on(e, e.conclusion->table, " Checked on", ".") + "\n\n";
  for (const ClaimCase& c : e.claims)
    out += fmt::format("- Claim ({}): {}. Verdict{}: **{}**.\n", c.where, c.claim,
                       checked_on(e, c.table, " (checked on", ")"), c.verdict);
  return e.claims.empty() ? out : out + "\n";
}

// The gates of the rows, counted.
std::string count_text(const std::vector<GateResult>& gates) {
  if (gates.empty()) return "";
  const GateCounts counts = count(gates);
  const std::string failed = counts.failed ? fmt::format(", {} failed", counts.failed) : "",
                    skipped = counts.skipped ? fmt::format(", {} skipped", counts.skipped) : "";
  return fmt::format("{} of {} gates hold{}{}. A [gate](#gates) is a bound on a figure of a row.\n\n", counts.passed,
                     gates.size(), failed, skipped);
}

// Where the numbers come from: files of the project, and the command that makes the table again.
std::string origin(const Experiment& e) {
  std::vector<std::string> scenes;
  for (const SceneCase& scene : e.scenes) {
    if (scene.file.empty()) continue;
    const std::string file = scene.file.generic_string(),
                      name = fmt::format("`{}`", file.substr(file.rfind("/experiments/") + 1));
    if (std::find(scenes.begin(), scenes.end(), name) == scenes.end()) scenes.push_back(name);
  }
  return fmt::format(
      "- Experiment: `experiments/{}.toml`.\n{}- Run it again: `airlight experiment run {}{} --results DIR`.\n\n", e.id,
      scenes.empty() ? "" : fmt::format("- Scenes: {}.\n", fmt::join(scenes, ", ")), e.id,
      e.profile == "quick" ? "" : " --profile " + e.profile);
}

std::string conditions(const Experiment& e, const json& record) {
  const json &machine = record.at("machine"), &rows = record.at("rows");
  std::string out = "## Conditions\n\n";
  if (const std::string warning = machine.value("load_warning", ""); !warning.empty())
    out += fmt::format("- **{}.**\n", warning);
  if (record.contains("without_times")) out += fmt::format("- **{}.**\n", record["without_times"].get<std::string>());
  for (const json& r : record.at("references")) {
    const auto text = [&](const char* key) { return r.at(key).get<std::string>(); };
    const std::string samples = text("samples"), film = r.value("committed", "");  // old records name no film
    out += fmt::format(
        "- Reference of {}: `{}`, `{}`{}, {} once{}.\n", text("scene"), text("renderer"), text("settings"),
        samples.empty() ? "" : ", " + samples + " samples per pixel", duration(r.at("seconds")),
        film.empty()
            ? ""
            : fmt::format("; read from the committed film `{}`, made by {}: {}", film, text("made_by"), text("kept")));
  }
  std::set<std::string> devices;
  bool downloads = false, timed = false;
  for (const json& row : rows) {
    if (const std::string device = row.at("device"); !device.empty()) devices.insert(device);
    for (const json& stage : row.at("stages")) downloads |= stage.at("stage") == download_stage;
    timed |= row.at("runs") > 0;
  }
  for (const std::string& device : devices) out += fmt::format("- Device: {}.\n", device);
  out += fmt::format("- {}\n", e.kind->conditions());
  if (downloads)
    out +=
        "- A device's render ends when the frame is complete there, and no layer is read back; download: what reading back "
        "all layers adds.\n";
  if (timed)
    out += "- front: no other row of the scene is both faster and closer in the first metric, beyond the intervals.\n";
  const int threads = machine.at("threads"), asked = record.at("timing").at("threads");
  out += fmt::format("- Profile {}; {}, {} threads used of {}; airlight {} ({}).\n", e.profile,
                     machine.at("cpu").get<std::string>(), asked ? asked : threads, threads,
                     record.at("version").get<std::string>(), record.at("commit").get<std::string>());
  return out;
}

}  // namespace

std::string table_markdown(const Experiment& e, const std::vector<NamedTable>& tables, const json& record) {
  const std::vector<GateResult> gates = gates_of(record);
  std::string out = fmt::format("# {}\n\n", e.title);
  if (!record.at("complete").get<bool>())
    out += "This run is not complete: it was interrupted, or a scene failed. Rows are missing.\n\n";
  out += conclusion(e, record) + count_text(gates);
  for (const json& plot : record.at("plots"))
    out += fmt::format("![{}]({})\n", plot.at("title").get<std::string>(), plot.at("file").get<std::string>());
  if (!record.at("plots").empty()) out += "\n";
  for (const NamedTable& table : tables) {
    if (&table != &tables.front()) out += fmt::format("## {}\n\n{}", table.title, explanation(table.file));
    out += markdown(table.lines) + "\n";
  }
  out += "## About\n\n" + origin(e);
  if (!e.paper.empty()) out += fmt::format("{}.\n\n", e.paper);
  if (!e.about.empty()) out += e.about + "\n\n";
  if (!gates.empty()) {
    out += "## Gates\n\n";
    for (const GateResult& gate : gates) out += fmt::format("- {}: {}\n", word(gate), gate.text);
    out += "\n";
  }
  return out + conditions(e, record);
}

}  // namespace airlight::experiments
