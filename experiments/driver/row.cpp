#include "experiments/driver/row.h"

#include <charconv>
#include <cmath>
#include <limits>

#include "experiments/application/json_value.h"

namespace airlight::experiments {
using nlohmann::json;
namespace {

// NaN and infinity are null in JSON.
double number(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

json to_json(const FigureMap& map) {
  const auto axis = [](const FigureMap::Axis& a) { return json{{"label", a.label}, {"values", a.values}}; };
  return {{"label", map.label}, {"x", axis(map.x)}, {"y", axis(map.y)}, {"values", map.values}, {"lines", map.lines}};
}

FigureMap map_from_json(const json& j) {
  const auto axis = [](const json& a) { return FigureMap::Axis{a.at("label"), a.at("values")}; };
  FigureMap map{j.at("label"), axis(j.at("x")), axis(j.at("y")), {}, j.at("lines")};
  for (const json& value : j.at("values")) map.values.push_back(number(value));
  return map;
}

}  // namespace

json to_json(const Row& row) {
  json measures = json::array();
  for (const Measure& m : row.measures)
    measures.push_back({{"metric", m.name},
                        {"value", m.value},
                        {"low", m.low},
                        {"high", m.high},
                        {"noise_floor", m.floor},
                        {"below_noise_floor", m.below_floor}});
  json stages = json::array();
  for (const auto& [name, seconds] : row.stages) stages.push_back({{"stage", name}, {"seconds", seconds}});
  json j = {{"key", row.key},
            {"figures_key", row.figures_key},
            {"scene", row.scene},
            {"method", row.method},
            {"setting", row.setting},
            {"renderer", row.renderer},
            {"settings", row.settings},
            {"layer", row.layer},
            {"film", {row.width, row.height}},
            {"scene_hash", row.scene_hash},
            {"reference", row.reference_key},
            {"errors", measures},
            {"note", row.note},
            {"unavailable", row.unavailable},
            {"runs", row.runs},
            {"seconds", {row.seconds.value, row.seconds.low, row.seconds.high}},
            {"seconds_interval_coverage", row.coverage},
            {"seconds_mad", row.mad},
            {"times", row.times},
            {"timed_together", row.group},
            {"waited", row.waited},
            {"prepare_seconds", row.prepare_seconds},
            {"stages", stages},
            {"device", row.device},
            {"counters", row.counters},
            {"image", row.image},
            {"exposure", row.exposure}};
  for (const auto& [what, after] : row.moved) j["moved"][what] = {{"seconds", after.seconds}, {"anew", after.anew}};
  if (row.parameter) j["parameter"] = *row.parameter;
  if (!row.left_out.empty()) j["left_out"] = row.left_out;
  if (row.map) j["map"] = to_json(*row.map);
  if (!row.columns.empty()) j["columns"] = row.columns;
  if (!row.made_on.empty()) j["made_on"] = row.made_on;
  return j;
}

void forget_times(Row& row) {
  row.runs = 0;
  row.seconds = {0, 0, 0};
  row.coverage = row.mad = row.waited = row.prepare_seconds = 0;
  row.times.clear();
  row.group.clear();
  row.moved.clear();
  row.stages.clear();
}

bool is_processor(const std::string& device) { return device.find("no GPU") != std::string::npos; }

Row row_from_json(const json& j) {
  Row row;
  const auto text = [&](const char* name, std::string& out) { j.at(name).get_to(out); };
  text("key", row.key);
  row.figures_key = j.value("figures_key", "");
  text("scene", row.scene);
  text("method", row.method);
  text("setting", row.setting);
  text("renderer", row.renderer);
  text("settings", row.settings);
  text("layer", row.layer);
  text("scene_hash", row.scene_hash);
  text("reference", row.reference_key);
  text("note", row.note);
  text("image", row.image);
  text("device", row.device);
  for (const json& m : j.at("errors"))
    row.measures.push_back({m.at("metric"), number(m.at("value")), number(m.at("low")), number(m.at("high")),
                            number(m.at("noise_floor")), m.at("below_noise_floor")});
  row.unavailable = j.at("unavailable");
  row.width = j.at("film").at(0);
  row.height = j.at("film").at(1);
  row.runs = j.at("runs");
  row.seconds = {j.at("seconds").at(0), j.at("seconds").at(1), j.at("seconds").at(2)};
  row.coverage = j.at("seconds_interval_coverage");
  row.mad = j.at("seconds_mad");
  if (j.contains("times")) j.at("times").get_to(row.times);  // a record leaves them out
  row.group = j.value("timed_together", "");                 // records of old programs have neither
  row.waited = j.value("waited", 0.0);
  row.prepare_seconds = j.at("prepare_seconds");
  for (const json& s : j.at("stages")) row.stages.emplace_back(s.at("stage"), s.at("seconds"));
  for (const auto& [name, value] : j.at("counters").items()) row.counters[name] = number(value);
  row.exposure = number(j.at("exposure"));
  if (j.contains("parameter")) row.parameter = j.at("parameter").get<double>();
  if (j.contains("moved"))
    for (const auto& [what, after] : j.at("moved").items()) row.moved[what] = {after.at("seconds"), after.at("anew")};
  row.left_out = j.value("left_out", "");
  row.made_on = j.value("made_on", "");
  if (j.contains("map")) row.map = map_from_json(j.at("map"));
  if (j.contains("columns"))
    for (const auto& [name, values] : j.at("columns").items())
      for (const json& value : values) row.columns[name].push_back(number(value));
  return row;
}

namespace {

// Into how many of what the name says a flow's whole run is divided; 0 for other names and rows.
double parts_of_run(const Row& row, const std::string& name) {
  const auto counter = [&](const char* what) {
    const auto found = row.counters.find(what);
    return found == row.counters.end() || row.runs == 0 ? 0 : found->second;
  };
  if (name == "step_seconds") return counter("steps");
  if (name == "cell_seconds") return counter("steps") * counter("cells");
  return name == "simulated_seconds" ? counter("simulated seconds") : 0;
}

}  // namespace

std::optional<Estimate> quantity(const Row& row, const std::string& name) {
  const auto plain = [](double x) { return Estimate{x, x, x}; };
  if (name == "seconds") return row.runs ? std::optional(row.seconds) : std::nullopt;
  if (name == "prepare_seconds") return row.runs ? std::optional(plain(row.prepare_seconds)) : std::nullopt;
  if (name == "total_seconds") {
    const double before = row.prepare_seconds;
    return row.runs ? std::optional(
                          Estimate{before + row.seconds.value, before + row.seconds.low, before + row.seconds.high})
                    : std::nullopt;
  }
  for (const auto& [what, after] : row.moved)
    if (name == what + "_seconds") return plain(after.seconds);
  if (const double parts = parts_of_run(row, name); parts > 0)
    return Estimate{row.seconds.value / parts, row.seconds.low / parts, row.seconds.high / parts};
  if (name == "parameter") return row.parameter ? std::optional(plain(*row.parameter)) : std::nullopt;
  if (name == "setting") {
    double value = 0;
    const auto [end, code] = std::from_chars(row.setting.data(), row.setting.data() + row.setting.size(), value);
    const bool good = code == std::errc() && end == row.setting.data() + row.setting.size();
    return good ? std::optional(plain(value)) : std::nullopt;
  }
  if (name.rfind("counter.", 0) == 0) {
    const auto found = row.counters.find(name.substr(8));
    return found == row.counters.end() ? std::nullopt : std::optional(plain(found->second));
  }
  for (const Measure& m : row.measures)
    if (m.name == name && !std::isnan(m.value)) return Estimate{m.value, m.low, m.high};
  return std::nullopt;
}

}  // namespace airlight::experiments
