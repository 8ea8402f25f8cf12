#include "experiments/driver/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/driver/agreement.h"
#include "experiments/driver/expected.h"
#include "experiments/driver/kind.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"

namespace airlight::experiments {
namespace {

using Cells = std::vector<std::string>;

constexpr const char* rows_file = "summary.csv";

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : ""; }

std::string csv_line(const Cells& cells) {
  Cells fields;
  for (const std::string& cell : cells) fields.push_back(csv_field(cell));
  return fmt::format("{}\n", fmt::join(fields, ","));
}

std::string csv(const TextTable& lines) {
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

bool has_films(const Outcome& outcome) {
  return any(outcome, [](const Row& r) { return r.width > 0; });
}

// Size of the row's film in pixels; empty where the row renders none.
std::string film_size(const Row& row) { return row.width > 0 ? fmt::format("{}x{}", row.width, row.height) : ""; }

// The table for people, header first.
TextTable summary(const Outcome& outcome) {
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
  const bool films = has_films(outcome);
  if (films) head.insert(head.end(), {"film", "profile"});
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
  TextTable lines{head};
  for (std::size_t i = 0; i < outcome.rows.size(); ++i) {
    const Row& row = outcome.rows[i];
    Cells line;
    if (scene) line.push_back(row.scene);
    if (parameter) line.push_back(row.parameter ? fmt::format("{:g}", *row.parameter) : "");
    line.push_back(row.method);
    if (setting) line.push_back(row.setting);
    if (films) line.insert(line.end(), {film_size(row), outcome.experiment.profile});
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
TextTable stage_table(const Outcome& outcome) {
  std::vector<std::string> names;
  for (const Row& row : outcome.rows)
    for (const auto& [name, seconds] : row.stages)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  Cells head{"scene", "method", "frames per second"};
  for (const std::string& name : names) head.push_back(name + " [ms]");
  TextTable lines{head};
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

// A table that csv() wrote.
TextTable read_table(const std::filesystem::path& file) {
  TextTable lines;
  std::istringstream text(scene::read_whole_file(file.string()));
  for (std::string line; std::getline(text, line);)
    lines.push_back(csv_fields(line, fmt::format("{}:{}", file.string(), lines.size() + 1)));
  return lines;
}

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

std::vector<std::string> csv_fields(const std::string& line, const std::string& where) {
  std::vector<std::string> all(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      all.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      all.emplace_back();
    } else {
      all.back() += c;
    }
  }
  if (quoted) throw Error(where + ": a quote is not closed");
  return all;
}

std::string table_csv(const Outcome& outcome) {
  std::set<std::string> counters;
  for (const Row& row : outcome.rows)
    for (const auto& [name, value] : row.counters) counters.insert(name);
  Cells head{"scene", "parameter", "method", "setting", "renderer", "settings", "layer"};
  const bool films = has_films(outcome);
  if (films) head.insert(head.end(), {"film", "profile"});
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
    if (films) line.insert(line.end(), {film_size(row), outcome.experiment.profile});
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

std::vector<NamedTable> tables(const Outcome& outcome) {
  const Experiment& e = outcome.experiment;
  std::vector<NamedTable> all{{rows_file, e.title, summary(outcome)}};
  if (e.stages) all.push_back({"stages.csv", "Stages", stage_table(outcome)});
  if (!e.expected.empty()) all.push_back({"expected.csv", "Printed and measured", expected_table(outcome)});
  if (!e.speed_ups.empty()) all.push_back({"speed_up.csv", "Equal error, equal time", equal_error_and_time(outcome)});
  if (e.orders)
    if (const TextTable lines = orders(outcome); lines.size() > 1) all.push_back({"orders.csv", "Orders", lines});
  return all;
}

std::map<std::string, std::string> table_files(const Outcome& outcome, const std::vector<NamedTable>& tables,
                                               const nlohmann::json& record) {
  std::map<std::string, std::string> files{{"table.csv", table_csv(outcome)},
                                           {"table.md", table_markdown(outcome.experiment, tables, record)}};
  for (const NamedTable& table : tables) files[table.file] = csv(table.lines);
  return files;
}

std::map<std::string, std::string> recorded_tables(const Experiment& experiment, const std::filesystem::path& folder) {
  const std::string file = (folder / "run.json").string();
  const auto rows = recorded_rows(file);
  if (!rows) return {};
  Outcome outcome;
  outcome.experiment = experiment;
  outcome.rows = *rows;
  const nlohmann::json record = read_json(file);
  try {
    std::vector<NamedTable> all;
    for (const nlohmann::json& table : record.at("tables")) {
      const std::string name = table.at("file");
      all.push_back({name, table.at("title"), name == rows_file ? summary(outcome) : read_table(folder / name)});
    }
    return table_files(outcome, all, record);
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("{}: not a record of this version: {}", file, error.what()));
  }
}

}  // namespace airlight::experiments
