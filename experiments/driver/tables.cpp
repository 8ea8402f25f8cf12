#include "experiments/driver/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/application/build_info.h"
#include "experiments/application/machine.h"
#include "experiments/driver/comparisons.h"
#include "experiments/driver/expected.h"
#include "experiments/driver/kind.h"

namespace airlight::experiments {
namespace {

using Cells = std::vector<std::string>;

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : ""; }

std::string csv_line(const Cells& cells) {
  Cells fields;
  for (const std::string& cell : cells) fields.push_back(csv_field(cell));
  return fmt::format("{}\n", fmt::join(fields, ","));
}

std::string csv(const std::vector<Cells>& lines) {
  std::string out;
  for (const Cells& line : lines) out += csv_line(line);
  return out;
}

// The name alone, and a warning where its times are not those of a GPU; the whole description stands in the conditions.
std::string device_text(const Row& row) {
  if (row.runs == 0) return "";
  if (row.device.empty()) return "CPU";
  const std::string name = row.device.substr(0, std::min(row.device.find(" ("), row.device.find(',')));
  return is_processor(row.device) ? name + ", no GPU" : name;
}

// [s] Nothing where no layer came from a device.
std::optional<double> download(const Row& row) {
  for (const auto& [name, seconds] : row.stages)
    if (name == download_stage) return seconds;
  return std::nullopt;
}

bool any(const Outcome& outcome, bool (*has)(const Row&)) {
  return std::any_of(outcome.rows.begin(), outcome.rows.end(), has);
}

// The table for people, header first.
std::vector<Cells> summary(const Outcome& outcome) {
  const bool parameter = any(outcome, [](const Row& r) { return r.parameter.has_value(); });
  const bool setting = any(outcome, [](const Row& r) { return !r.setting.empty(); });
  const bool note = any(outcome, [](const Row& r) { return !r.note.empty(); });
  const bool device = any(outcome, [](const Row& r) { return !r.device.empty(); });
  const bool scene = any(outcome, [](const Row& r) { return !r.scene.empty(); });
  const bool timed = any(outcome, [](const Row& r) { return r.runs > 0; });
  Cells head;
  if (scene) head.push_back("scene");
  if (parameter) head.push_back("parameter");
  head.push_back("method");
  if (setting) head.push_back("setting");
  for (const std::string& metric : outcome.experiment.metrics) head.push_back(metric);
  using Columns = std::vector<RowColumn>;
  const Columns times = timed ? outcome.experiment.kind->time_columns() : Columns{};
  Columns preparations = timed ? outcome.experiment.kind->preparation_columns() : Columns{};
  std::erase_if(preparations, [&](const RowColumn& column) {
    return std::all_of(outcome.rows.begin(), outcome.rows.end(),
                       [&](const Row& row) { return column.text(row).empty(); });
  });
  for (const RowColumn& column : times) head.push_back(column.head);
  const bool downloads = any(outcome, [](const Row& r) { return download(r).has_value(); });
  if (downloads) head.push_back("download");
  for (const RowColumn& column : preparations) head.push_back(column.head);
  const bool compared = timed && !outcome.experiment.metrics.empty();
  const std::vector<bool> best = on_front(outcome);
  if (compared) head.push_back("front");
  if (device) head.push_back("device");
  if (outcome.experiment.left_out) head.push_back("leaves out");
  if (note) head.push_back("note");
  std::vector<Cells> lines{head};
  for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
    const Row& row = outcome.rows[i];
    Cells line;
    if (scene) line.push_back(row.scene);
    if (parameter) line.push_back(row.parameter ? fmt::format("{:g}", *row.parameter) : "");
    line.push_back(row.method);
    if (setting) line.push_back(row.setting);
    for (const std::string& metric : outcome.experiment.metrics) {
      const auto found =
          std::find_if(row.measures.begin(), row.measures.end(), [&](const Measure& m) { return m.name == metric; });
      line.push_back(found == row.measures.end() ? "" : text(*found));
    }
    for (const RowColumn& column : times) line.push_back(column.text(row));
    if (downloads) line.push_back(download(row) ? duration(*download(row)) : "");
    for (const RowColumn& column : preparations) line.push_back(column.text(row));
    if (compared) line.push_back(best[i] ? "yes" : "");
    if (device) line.push_back(device_text(row));
    if (outcome.experiment.left_out) line.push_back(row.left_out);
    if (note) line.push_back(row.note);
    lines.push_back(line);
  }
  return lines;
}

// Milliseconds of every stage of every row, header first.
std::vector<Cells> stage_table(const Outcome& outcome) {
  std::vector<std::string> names;
  for (const Row& row : outcome.rows)
    for (const auto& [name, seconds] : row.stages)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  Cells head{"scene", "method", "frames per second"};
  for (const std::string& name : names) head.push_back(name + " [ms]");
  std::vector<Cells> lines{head};
  for (const Row& row : outcome.rows) {
    if (row.runs == 0) continue;
    Cells line{row.scene, row.setting.empty() ? row.method : row.method + " " + row.setting,
               fmt::format("{:.3g}", 1 / row.seconds.value)};
    for (const std::string& name : names) {
      const auto found =
          std::find_if(row.stages.begin(), row.stages.end(), [&](const auto& stage) { return stage.first == name; });
      line.push_back(found == row.stages.end() ? "" : fmt::format("{:.3g}", 1e3 * found->second));
    }
    lines.push_back(line);
  }
  return lines;
}

std::string markdown(const std::vector<Cells>& lines) {
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += fmt::format("| {} |\n", fmt::join(lines[i], " | "));
    if (i == 0) out += fmt::format("|{}|\n", fmt::join(Cells(lines[0].size(), "---"), "|"));
  }
  return out;
}

// Where the setting is how fine the grid is.
TextTable orders_of(const Outcome& outcome) { return outcome.experiment.orders ? orders(outcome) : TextTable{}; }

}  // namespace

std::string csv_field(const std::string& text) {
  // A line that begins with '#' is a comment to those who draw the data.
  if (text.find_first_of(",\"\n") == std::string::npos && !text.starts_with('#')) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::string table_csv(const Outcome& outcome) {
  std::set<std::string> counters;
  for (const Row& row : outcome.rows)
    for (const auto& [name, value] : row.counters) counters.insert(name);
  Cells head{"scene", "parameter", "method", "setting", "renderer", "settings", "layer"};
  for (const std::string& metric : outcome.experiment.metrics)
    for (const char* suffix : {"", "_low", "_high", "_noise_floor"}) head.push_back(metric + suffix);
  head.insert(head.end(), {"seconds", "seconds_low", "seconds_high", "seconds_mad", "runs", "prepare_seconds"});
  const bool downloads = any(outcome, [](const Row& r) { return download(r).has_value(); });
  if (downloads) head.push_back("download_seconds");
  for (const Moving::What what : outcome.experiment.moves) head.push_back(name_of(what) + "_seconds");
  for (const std::string& counter : counters) head.push_back("counter." + counter);
  if (outcome.experiment.left_out) head.push_back("left_out");
  head.push_back("note");
  std::string out = csv_line(head);
  for (const Row& row : outcome.rows) {
    Cells line{
        row.scene, row.parameter ? number(*row.parameter) : "", row.method, row.setting, row.renderer, row.settings,
        row.layer};
    for (const std::string& metric : outcome.experiment.metrics) {
      const auto m =
          std::find_if(row.measures.begin(), row.measures.end(), [&](const Measure& x) { return x.name == metric; });
      if (m == row.measures.end())
        line.insert(line.end(), 4, "");
      else
        line.insert(line.end(), {number(m->value), number(m->low), number(m->high), number(m->floor)});
    }
    if (row.runs == 0)
      line.insert(line.end(), 6, "");
    else
      line.insert(line.end(), {number(row.seconds.value), number(row.seconds.low), number(row.seconds.high),
                               number(row.mad), std::to_string(row.runs), number(row.prepare_seconds)});
    if (downloads) line.push_back(download(row) ? number(*download(row)) : "");
    for (const Moving::What what : outcome.experiment.moves) {
      const auto after = row.moved.find(name_of(what));
      line.push_back(after == row.moved.end() ? "" : number(after->second.seconds));
    }
    for (const std::string& counter : counters) {
      const auto found = row.counters.find(counter);
      line.push_back(found == row.counters.end() ? "" : number(found->second));
    }
    if (outcome.experiment.left_out) line.push_back(row.left_out);
    line.push_back(row.note);
    out += csv_line(line);
  }
  return out;
}

std::string summary_csv(const Outcome& outcome) { return csv(summary(outcome)); }

std::map<std::string, std::string> table_files(const Outcome& outcome, const std::vector<PlotFile>& plots) {
  const Experiment& e = outcome.experiment;
  std::map<std::string, std::string> files{{"table.csv", table_csv(outcome)},
                                           {"summary.csv", summary_csv(outcome)},
                                           {"table.md", table_markdown(outcome, plots)}};
  if (e.stages) files["stages.csv"] = csv(stage_table(outcome));
  if (!e.expected.empty()) files["expected.csv"] = csv(expected_table(outcome));
  if (const auto lines = orders_of(outcome); lines.size() > 1) files["orders.csv"] = csv(lines);
  if (!e.speed_ups.empty()) files["speed_up.csv"] = csv(equal_error_and_time(outcome));
  return files;
}

std::string table_markdown(const Outcome& outcome, const std::vector<PlotFile>& plots) {
  const Experiment& e = outcome.experiment;
  std::string out = fmt::format("# {}\n\n", e.title);
  if (!e.summary.empty()) out += summary_text(outcome) + "\n\n";
  if (!e.paper.empty()) out += fmt::format("{}.\n\n", e.paper);
  if (!e.about.empty()) out += e.about + "\n\n";
  if (!outcome.complete)
    out += "This run is not complete: it was interrupted, or a scene failed. Rows are missing.\n\n";
  out += markdown(summary(outcome)) + "\n";
  if (e.stages)
    out += "## Stages\n\nOf one render, median of the runs; a blank is a stage that the row does not have.\n\n" +
           markdown(stage_table(outcome)) + "\n";
  if (!e.expected.empty()) {
    out += "## Printed and measured\n\n" + markdown(expected_table(outcome)) + "\n";
  }
  if (!e.speed_ups.empty()) out += "## Equal error, equal time\n\n" + markdown(equal_error_and_time(outcome)) + "\n";
  if (const auto lines = orders_of(outcome); lines.size() > 1)
    out += "## Orders\n\nOf the fall of the error from each setting to the next.\n\n" + markdown(lines) + "\n";
  for (const PlotFile& plot : plots) out += fmt::format("![{}]({})\n", plot.title, plot.file);
  if (!plots.empty()) out += "\n";
  if (!outcome.gates.empty()) {
    out += "## Gates\n\n";
    for (const GateResult& gate : outcome.gates) out += fmt::format("- {}: {}\n", word(gate), gate.text);
    out += "\n";
  }
  const Machine machine = this_machine();
  out += "## Conditions\n\n";
  if (const std::string warning = load_warning(outcome); !warning.empty()) out += fmt::format("- **{}.**\n", warning);
  for (const ReferenceInfo& r : outcome.references)
    out += fmt::format("- Reference of {}: `{}`, `{}`{}, {} once{}.\n", r.scene, r.renderer, r.settings,
                       r.samples.empty() ? "" : ", " + r.samples + " samples per pixel", duration(r.seconds),
                       r.committed.empty() ? ""
                                           : fmt::format("; read from the committed film `{}`, made by {}: {}",
                                                         r.committed, r.program, r.kept));
  std::set<std::string> devices;
  for (const Row& row : outcome.rows)
    if (!row.device.empty()) devices.insert(row.device);
  for (const std::string& device : devices) out += fmt::format("- Device: {}.\n", device);
  out += fmt::format("- {}\n", e.kind->conditions());
  if (any(outcome, [](const Row& r) { return download(r).has_value(); }))
    out +=
        "- A device's render ends when the frame is complete there, and no layer is read back; download: what reading back "
        "all layers adds.\n";
  if (any(outcome, [](const Row& r) { return r.runs > 0; }))
    out += "- front: no other row of the scene is both faster and closer in the first metric, beyond the intervals.\n";
  out += fmt::format("- Profile {}; {}, {} threads used of {}; airlight {} ({}).\n", e.profile, machine.cpu,
                     e.timing.threads ? e.timing.threads : machine.threads, machine.threads, version(), commit());
  return out;
}

}  // namespace airlight::experiments
