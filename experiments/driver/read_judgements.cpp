// Plots, gates, speed-ups, expected figures and the summary of an experiment's file, and the names that they refer to.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "experiments/application/renderers.h"
#include "experiments/driver/bounds.h"
#include "experiments/driver/expected.h"
#include "experiments/driver/experiment_reader.h"
#include "experiments/driver/pictures.h"
#include "experiments/driver/plots.h"
#include "experiments/driver/toml_values.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
using scene::load::TableReader;

void ExperimentReader::plots(const TableReader& top) {
  for (auto& [table, reader] : lists(top, "plot")) {
    PlotCase plot;
    plot.position = scene::load::location(table->source());
    if (table->contains("map")) {
      reader.allow({"name", "title", "map"});
      plot.map = reader.flag("map", true);
      plot.name = reader.name("name", "map");
      plot.title = reader.text("title", "");
      experiment_.plots.push_back(plot);
      continue;
    }
    reader.allow({"name", "title", "x", "y", "x_label", "y_label", "per_scene", "methods"});
    plot.x = reader.text("x");
    plot.y = reader.text("y");
    plot.name = reader.name("name", plot.y + "_against_" + plot.x);
    plot.title = reader.text("title", "");
    plot.x_label = reader.text("x_label", "");
    plot.y_label = reader.text("y_label", "");
    plot.per_scene = reader.flag("per_scene", plot.x != "parameter");
    plot.methods = strings(*table, "methods", reader);
    for (const std::string& name : plot.methods) known(reader, "methods", name, "method");
    for (const std::string key : {"x", "y"}) {
      const std::string& axis = key == "x" ? plot.x : plot.y;
      std::vector<std::string> axes = kind().times();
      axes.insert(axes.end(), {"parameter", "setting"});
      const bool known =
          std::find(axes.begin(), axes.end(), axis) != axes.end() || axis.starts_with("counter.") ||
          axis.starts_with("column.") ||
          std::find(experiment_.metrics.begin(), experiment_.metrics.end(), axis) != experiment_.metrics.end();
      if (!known)
        reader.expected(key, fmt::format("one of {}, counter.NAME, column.NAME, {}", fmt::join(axes, ", "),
                                         fmt::join(experiment_.metrics, ", ")));
    }
    if (plot.x.starts_with("column.") != plot.y.starts_with("column."))
      reader.fail("y", fmt::format("{} against {}, expected both columns or none", plot.y, plot.x));
    experiment_.plots.push_back(plot);
  }
}

void ExperimentReader::names_apart() const {
  using Owners = std::map<std::string, std::string>;  // of each file or row: who has it, in words
  const auto claim = [](Owners& owners, const std::string& what, const std::string& name, const std::string& owner,
                        const std::string& position) {
    const auto [found, is_new] = owners.try_emplace(name, owner);
    if (!is_new)
      throw Error(fmt::format("{}: {} '{}' of {} is that of {}, too: expected names that differ in letters or digits",
                              position, what, name, owner, found->second));
  };
  const bool pictures = kind().draws_pictures();
  const auto folded = [&](const std::string& name) { return pictures ? file_name(name) : name; };
  Owners scenes, plots;
  for (const SceneCase& c : experiment_.scenes) {
    claim(scenes, pictures ? "the folder of pictures" : "the name", folded(c.name), fmt::format("scene '{}'", c.name),
          c.position);
    Owners rows;
    if (pictures && !experiment_.reference.renderer.empty()) rows["reference"] = "the reference";
    for (const MethodCase& m : experiment_.methods) {
      if (!is_on(m, c)) continue;
      const std::string owner = m.setting.empty() ? fmt::format("method '{}'", m.name)
                                                  : fmt::format("method '{}' with setting '{}'", m.name, m.setting);
      claim(rows, pictures ? "the picture" : "the row",
            pictures ? picture_name(m.name, m.setting) : m.name + " " + m.setting, owner, m.position);
    }
  }
  for (const PlotCase& plot : experiment_.plots)
    for (const SceneCase& c : experiment_.scenes) {
      const bool apart = plot.per_scene && !plot.map;
      claim(plots, "the file", plot_name(plot, apart ? c.name : ""), fmt::format("plot '{}'", plot.name),
            plot.position);
      if (!apart) break;
    }
}

void ExperimentReader::known(const TableReader& reader, const std::string& key, const std::string& value,
                             const std::string& list) const {
  std::vector<std::string> names;
  if (list == "metric") {
    if (value.rfind("counter.", 0) == 0) return;
    names = experiment_.metrics;
    for (const std::string& time : kind().times()) names.push_back(time);
    names.push_back("counter.NAME");
  } else if (const toml::array* array = toml_.get_as<toml::array>(list)) {
    for (const toml::node& node : *array) {
      const toml::table& table = *node.as_table();
      const std::string source = list == "scene" ? "file" : kind().component_key();
      const std::string fallback = table[source].value_or(std::string());
      names.push_back(table["name"].value_or(list == "scene" ? fs::path(fallback).stem().string() : fallback));
    }
    if (list == "scene")
      for (const SceneCase& scene : experiment_.scenes) names.push_back(scene.name);
  }
  if (std::find(names.begin(), names.end(), value) == names.end())
    reader.expected(key, fmt::format("one of {}{}", fmt::join(names, ", "), scene::nearest_hint(value, names)));
}

void ExperimentReader::has_figures(const TableReader& reader, const GateCase& gate) const {
  const auto wrong = [&](const std::string& what) {
    reader.fail("", fmt::format("{} in profile {}", what, experiment_.profile));
  };
  const std::vector<std::string> tests = {"objections", "largest_z", "detectable_bias"};
  const std::vector<std::string> of_time = kind().times();
  const bool of_time_or_work =
      gate.metric.starts_with("counter.") || std::find(of_time.begin(), of_time.end(), gate.metric) != of_time.end();
  const bool test = std::find(tests.begin(), tests.end(), gate.metric) != tests.end();
  const auto noisy = [this](const std::string& name) {
    return kind().draws_pictures() && !name.empty() && find_renderer(name, "gate").monte_carlo();
  };
  bool found = false;
  std::vector<std::string> settings;  // that the method has there
  for (const SceneCase& c : experiment_.scenes)
    for (const MethodCase& m : experiment_.methods) {
      if (is_on(m, c) && m.name == gate.method && judges(gate, c.name, m.name, gate.setting) &&
          std::find(settings.begin(), settings.end(), m.setting) == settings.end())
        settings.push_back(m.setting);
      if (!judges(gate, c.name, m.name, m.setting) || !is_on(m, c)) continue;
      found = true;
      if (of_time_or_work || !kind().draws_pictures()) continue;
      if (m.picture_only && gate.method.empty()) continue;  // every method that has figures
      if (m.picture_only) wrong(fmt::format("method '{}' is picture_only: it has no {}", m.name, gate.metric));
      const bool noisy_reference = noisy(reference_of(experiment_, c).renderer);
      if (test && !noisy_reference && !noisy(m.renderer))
        wrong(fmt::format("{} needs noise, and neither '{}' nor the reference has any", gate.metric, m.name));
      if (gate.metric == "wrong" && noisy_reference) wrong("wrong is not defined against a noisy reference");
    }
  if (!found)
    wrong(fmt::format("there is no row of method '{}'{}{}{}", gate.method,
                      gate.setting.empty() ? "" : fmt::format(" with setting {}", gate.setting),
                      gate.scene.empty() ? "" : fmt::format(" on scene '{}'", gate.scene),
                      gate.setting.empty() || settings.empty()
                          ? ""
                          : fmt::format("; its settings are {}", fmt::join(settings, ", "))));
}

void ExperimentReader::checks(const TableReader& top) {
  for (auto& [table, reader] : lists(top, "gate")) {
    reader.allow({"scene", "method", "setting", "metric", "at_most", "at_least", "why", "profiles"});
    GateCase gate;
    gate.scene = reader.text("scene", "");
    gate.method = reader.text("method", "");
    gate.metric = reader.text("metric");
    if (reader.has("setting")) gate.setting = plain(*table->get("setting"));
    gate.why = reader.text("why", "");
    gate.position = scene::load::location(table->source());
    if (!gate.scene.empty()) known(reader, "scene", gate.scene, "scene");
    if (!gate.method.empty()) known(reader, "method", gate.method, "method");
    known(reader, "metric", gate.metric, "metric");
    const bool bounded = reader.has("at_most") || reader.has("at_least");  // else by row alone
    if (bounded) reader.one_of({"at_most", "at_least"});
    if (reader.has("at_most")) gate.at_most = reader.number("at_most", scene::load::any_number);
    if (reader.has("at_least")) gate.at_least = reader.number("at_least", scene::load::any_number);
    if (!in_profile(*table, reader) || !(bounded || experiment_.profile == "quick")) continue;
    has_figures(reader, gate);
    experiment_.gates.push_back(gate);
  }
  if (experiment_.profile == "quick") add_bounds(experiment_, fs::path(file_).replace_extension(".bounds.csv"));
  for (auto& [table, reader] : lists(top, "speed_up")) {
    reader.allow({"baseline", "method", "metric"});
    experiment_.speed_ups.push_back({reader.text("baseline"), reader.text("method"), reader.text("metric")});
    known(reader, "baseline", experiment_.speed_ups.back().baseline, "method");
    known(reader, "method", experiment_.speed_ups.back().method, "method");
    known(reader, "metric", experiment_.speed_ups.back().metric, "metric");
  }
  for (auto& [table, reader] : lists(top, "expected")) {
    reader.allow({"what", "paper", "scene", "method", "setting", "metric", "baseline", "unit"});
    ExpectedCase e;
    e.what = reader.text("what");
    e.paper = reader.text("paper");
    if (reader.has("method")) {
      if (kind().needs_scene() || reader.has("scene")) known(reader, "scene", e.scene = reader.text("scene"), "scene");
      e.method = reader.text("method");
      e.metric = reader.text("metric");
      if (reader.has("setting")) e.setting = plain(*table->get("setting"));
      known(reader, "method", e.method, "method");
      known(reader, "metric", e.metric, "metric");
      if (reader.has("baseline")) e.baseline = baseline_of(reader, e);
      if (reader.has("unit")) e.unit = reader.choice("unit", expected_units());
      if (!e.unit.empty() && !fits_unit(e)) reader.expected("unit", "a unit that " + e.metric + " can have");
    }
    experiment_.expected.push_back(e);
  }
}

std::string ExperimentReader::baseline_of(const TableReader& reader, const ExpectedCase& e) const {
  std::string baseline = reader.text("baseline");
  known(reader, "baseline", baseline, "method");
  if (reader.has("setting")) reader.fail("setting", "has no effect beside baseline: a speed-up is of all settings");
  const auto& all = experiment_.speed_ups;
  if (std::none_of(all.begin(), all.end(), [&](const SpeedUpCase& s) {
        return s.baseline == baseline && s.method == e.method && s.metric == e.metric;
      }))
    reader.fail("baseline", fmt::format("there is no [[speed_up]] with baseline '{}', method '{}' and metric '{}'",
                                        baseline, e.method, e.metric));
  return baseline;
}

void ExperimentReader::check_summary(const TableReader& top) const {
  const auto& expected = experiment_.expected;
  if (experiment_.summary.find('\n') != std::string::npos) top.fail("summary", "expected one line");
  try {
    fill_in(experiment_.summary, [&](std::size_t n) -> std::string {
      if (n < 1 || n > expected.size())
        throw Error(fmt::format("found {{{}}}, expected the number of an [[expected]], of which there are {}", n,
                                expected.size()));
      if (expected[n - 1].method.empty())
        throw Error(fmt::format("found {{{}}}, but that [[expected]] has no method and no figure", n));
      return "";
    });
  } catch (const Error& error) {
    top.fail("summary", fmt::format("summary: {}", error.what()));
  }
}

void ExperimentReader::claims(const TableReader& top) {
  const auto paper_exists = [&](const TableReader& reader) {
    if (reader.has("group") && !fs::is_directory(folders_.root / "experiments" / reader.file_name("group")))
      reader.expected("group", "a folder of experiments/");
  };
  const auto folder_of = [&](const TableReader& reader) {
    const fs::path table = reader.text("table", experiment_.id);
    return (table.extension() == ".csv" ? table.parent_path() : table).string();
  };
  if (auto reader = top.table("conclusion")) {
    reader->allow({"text", "holds", "table"});
    reader->text("holds");
    experiment_.conclusion = {reader->text("text"), folder_of(*reader)};
  }
  for (auto& [table, reader] : lists(top, "claim")) {
    reader.allow({"where", "claim", "published", "improved", "verdict", "holds", "group", "table", "pictures"});
    for (const std::string key : {"published", "improved", "holds"}) reader.text(key, "");
    strings(*table, "pictures", reader);
    paper_exists(reader);
    const std::string verdict = reader.text("verdict");
    experiment_.claims.push_back({reader.text("where"), reader.text("claim"), verdict, folder_of(reader)});
    const std::string short_verdict = verdict.substr(0, verdict.find(':'));
    const std::vector<std::string> verdicts{"reproduced", "not reproduced", "failure reproduced", "not comparable"};
    if (!short_verdict.starts_with("holds only where ") &&
        std::find(verdicts.begin(), verdicts.end(), short_verdict) == verdicts.end())
      reader.expected("verdict", fmt::format("{} or holds only where ..., with : and a reason where that helps",
                                             fmt::join(verdicts, ", ")));
    if (short_verdict != "not comparable" && !reader.has("holds"))
      reader.fail("", "holds is missing: the condition on the tables that makes the verdict true");
  }
  for (auto& [table, reader] : lists(top, "erratum")) {
    reader.allow({"where", "printed", "right", "proof", "holds", "group", "table"});
    for (const std::string key : {"where", "printed", "right", "proof"}) reader.text(key);
    for (const std::string key : {"holds", "table"}) reader.text(key, "");
    paper_exists(reader);
  }
}

}  // namespace airlight::experiments
