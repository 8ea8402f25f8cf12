#include "experiments/driver/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/driver/tables.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

std::string nine_digits(double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : ""; }

// "variant=S K=8" as names and values.
std::vector<std::pair<std::string, std::string>> settings_of(const Row& row) {
  std::vector<std::pair<std::string, std::string>> pairs;
  std::istringstream words(row.settings);
  for (std::string word; words >> word;)
    if (const auto equals = word.find('='); equals != std::string::npos)
      pairs.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  return pairs;
}

std::string film_of(const Row& row) { return row.width > 0 ? fmt::format("{}x{}", row.width, row.height) : ""; }

std::string device_of(const Row& row) { return row.device.empty() ? "CPU" : row.device; }

// Calls `add` with each figure of each row, and once with none where a row has no figures.
template <class Add>
void for_each_figure(const std::vector<RecordedRun>& runs, const std::vector<std::string>& metrics, const Add& add) {
  for (const RecordedRun& run : runs)
    for (const Row& row : run.rows) {
      const std::vector<RecordedFigure> all = figures(row, metrics);
      for (const RecordedFigure& figure : all) add(run, row, &figure);
      if (all.empty() && !row.note.empty()) add(run, row, nullptr);
    }
}

}  // namespace

std::vector<std::string> record_names(const fs::path& results) {
  std::vector<std::string> names;
  if (!fs::is_directory(results)) return names;
  const std::set<std::string> other{"cache", "images", "rows"};
  for (auto entry = fs::recursive_directory_iterator(results); entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory() && entry.depth() == 0 && other.contains(entry->path().filename().string()))
      entry.disable_recursion_pending();
    if (entry->path().filename() == "run.json")
      names.push_back(entry->path().parent_path().lexically_relative(results).generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

RecordedRun read_run(const fs::path& results, const std::string& name) {
  RecordedRun run;
  run.name = name;
  run.folder = results / name;
  const std::string file = (run.folder / "run.json").string();
  const json record = read_json(file);
  try {
    run.experiment = record.at("experiment");
    run.profile = record.at("profile");
    run.title = record.at("title");
    run.commit = record.at("commit");
    const json& machine = record.at("machine");
    run.machine = fmt::format("{}, {} threads", machine.at("cpu").get<std::string>(), machine.at("threads").get<int>());
    run.plots = record.at("plots").size();
    for (const json& row : record.at("rows")) run.rows.push_back(row_from_json(row));
  } catch (const json::exception& error) {
    throw Error(fmt::format("{}: not a record of this version: {}", file, error.what()));
  }
  return run;
}

std::vector<RecordedFigure> figures(const Row& row, const std::vector<std::string>& metrics) {
  std::vector<RecordedFigure> all;
  for (const Measure& m : row.measures) all.push_back({m.name, {m.value, m.low, m.high}, m.floor, m.below_floor});
  std::vector<std::string> others{"seconds", "prepare_seconds"};
  for (const auto& [what, after] : row.moved) others.push_back(what + "_seconds");
  for (const auto& [counter, value] : row.counters) others.push_back("counter." + counter);
  for (const std::string& name : others)
    if (const auto value = quantity(row, name)) all.push_back({name, *value});
  if (metrics.empty()) return all;
  std::vector<RecordedFigure> chosen;
  for (const std::string& name : metrics) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const RecordedFigure& f) { return f.metric == name; });
    if (found != all.end()) chosen.push_back(*found);
  }
  return chosen;
}

std::string long_csv(const std::vector<RecordedRun>& runs, const std::vector<std::string>& metrics) {
  std::set<std::string> settings;
  for (const RecordedRun& run : runs)
    for (const Row& row : run.rows)
      for (const auto& [name, value] : settings_of(row)) settings.insert(name);
  std::string out = "experiment,profile,commit,machine,device,film,scene,parameter,method,setting,renderer,layer";
  for (const std::string& name : settings) out += ",setting." + name;
  out += ",metric,value,low,high,noise_floor,below_noise,note\n";
  for_each_figure(runs, metrics, [&](const RecordedRun& run, const Row& row, const RecordedFigure* figure) {
    std::vector<std::string> cells{
        run.experiment, run.profile,  run.commit,   run.machine,
        device_of(row), film_of(row), row.scene,    row.parameter ? nine_digits(*row.parameter) : "",
        row.method,     row.setting,  row.renderer, row.layer};
    const auto given = settings_of(row);
    for (const std::string& name : settings) {
      const auto found = std::find_if(given.begin(), given.end(), [&](const auto& pair) { return pair.first == name; });
      cells.push_back(found == given.end() ? "" : found->second);
    }
    if (figure)
      cells.insert(cells.end(),
                   {figure->metric, nine_digits(figure->value.value), nine_digits(figure->value.low),
                    nine_digits(figure->value.high), nine_digits(figure->floor), figure->below ? "true" : "false"});
    else
      cells.insert(cells.end(), 6, "");
    cells.push_back(row.note);
    for (std::size_t i = 0; i < cells.size(); ++i) out += (i ? "," : "") + csv_field(cells[i]);
    out += "\n";
  });
  return out;
}

std::string long_jsonl(const std::vector<RecordedRun>& runs, const std::vector<std::string>& metrics) {
  std::string out;
  for_each_figure(runs, metrics, [&](const RecordedRun& run, const Row& row, const RecordedFigure* figure) {
    nlohmann::ordered_json line = {{"experiment", run.experiment},
                                   {"profile", run.profile},
                                   {"commit", run.commit},
                                   {"machine", run.machine},
                                   {"device", device_of(row)},
                                   {"film", film_of(row)},
                                   {"scene", row.scene},
                                   {"parameter", nullptr},
                                   {"method", row.method},
                                   {"setting", row.setting},
                                   {"renderer", row.renderer},
                                   {"layer", row.layer},
                                   {"settings", nlohmann::ordered_json::object()}};
    if (row.parameter) line["parameter"] = *row.parameter;
    for (const auto& [name, value] : settings_of(row)) line["settings"][name] = value;
    if (figure) {
      line["metric"] = figure->metric;
      line["value"] = figure->value.value;
      line["low"] = figure->value.low;
      line["high"] = figure->value.high;
      line["noise_floor"] = figure->floor;
      line["below_noise"] = figure->below;
    }
    line["note"] = row.note;
    out += line.dump() + "\n";
  });
  return out;
}

}  // namespace airlight::experiments
