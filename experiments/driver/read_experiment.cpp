#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "experiments/application/probes.h"
#include "experiments/application/renderers.h"
#include "experiments/application/solvers.h"
#include "experiments/driver/bounds.h"
#include "experiments/driver/committed_references.h"
#include "experiments/driver/expected.h"
#include "experiments/driver/experiment.h"
#include "experiments/driver/next_frames.h"
#include "experiments/driver/pictures.h"
#include "experiments/driver/plots.h"
#include "experiments/driver/sequences.h"
#include "experiments/driver/toml_values.h"
#include "experiments/judging/flow_metrics.h"
#include "experiments/judging/metrics.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/read_file.h"
#include "scene/base/settings.h"
#include "scene/load/parse_toml.h"
#include "scene/load/table_reader.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
using scene::load::TableReader;
namespace {

class Reader {
 public:
  Reader(const Folders& folders, const std::string& id, const std::string& profile) : folders_(folders) {
    experiment_.id = id;
    experiment_.profile = profile;
    file_ = (folders.root / "experiments" / (id + ".toml")).string();
    toml_ = scene::load::parse_toml(scene::read_whole_file(file_, scene::load::most_toml_bytes), file_);
  }

  Experiment read() {
    TableReader top(toml_, "");
    experiment_.kind = toml_["kind"].value_or(std::string("images"));
    std::vector<std::string> keys{"kind",   "title", "paper", "about",    "summary",  "metrics", "in_tests", "scene",
                                  "method", "plot",  "gate",  "speed_up", "expected", "profile", "timing"};
    if (!numbers()) keys.insert(keys.end(), {"stages", "reference"});
    if (images()) keys.push_back("layer");
    if (flow()) keys.push_back("orders");
    top.allow(keys);
    top.choice("kind", {"images", "numbers", "flow"}, "images");
    experiment_.title = top.text("title");
    experiment_.paper = top.text("paper", "");
    experiment_.about = top.text("about", "");
    experiment_.summary = top.text("summary", "");
    experiment_.in_tests = top.flag("in_tests", false);
    if (images()) experiment_.layer = top.text("layer", "mean");
    if (flow()) experiment_.orders = top.flag("orders", false);
    if (!numbers()) experiment_.stages = top.flag("stages", false);
    experiment_.metrics = strings(toml_, "metrics", top);
    for (const std::string& metric : experiment_.metrics)
      if (images())
        check_metric_name(metric, position("metrics"));
      else if (flow())
        parse_flow_metric(metric, position("metrics"));
    if (images()) add_rms_errors();
    Pairs overrides, reference_settings;
    profile(top, overrides, reference_settings);
    if (!numbers()) reference(top, reference_settings);
    scenes(top, overrides);
    methods(top);
    if (numbers()) figures();
    plots(top);
    names_apart();
    checks(top);
    if (top.has("summary")) check_summary(top);
    return experiment_;
  }

 private:
  bool images() const { return experiment_.kind == "images"; }
  bool numbers() const { return experiment_.kind == "numbers"; }
  bool flow() const { return experiment_.kind == "flow"; }

  std::string position(const std::string& key) const {
    const toml::node* node = toml_.get(key);
    return scene::load::location(node ? node->source() : toml_.source());
  }

  // The tables of [[key]], each with its reader.
  std::vector<std::pair<const toml::table*, TableReader>> lists(const TableReader& top, const std::string& key) const {
    std::vector<std::pair<const toml::table*, TableReader>> all;
    if (!top.has(key)) return all;
    const toml::array* array = toml_.get(key)->as_array();
    if (!array) top.expected(key, fmt::format("tables [[{}]]", key));
    for (std::size_t i = 0; i < array->size(); ++i) {
      const toml::table* table = array->get_as<toml::table>(i);
      if (!table) top.expected(key, fmt::format("tables [[{}]]", key));
      all.emplace_back(table, TableReader(*table, fmt::format("{} {}", key, i)));
    }
    return all;
  }

  bool in_profile(const toml::table& table, const TableReader& reader) const {
    const auto profiles = strings(table, "profiles", reader);
    for (const std::string& p : profiles)
      if (p != "quick" && p != "paper") reader.expected("profiles", "a list of \"quick\" and \"paper\"");
    return profiles.empty() || std::find(profiles.begin(), profiles.end(), experiment_.profile) != profiles.end();
  }

  void profile(const TableReader& top, Pairs& scene_overrides, Pairs& reference_settings) {
    TimingRule& rule = experiment_.timing;
    if (experiment_.profile == "paper") rule = {31, 2, 60, 0};
    if (auto timing = top.table("timing")) {
      timing->allow({"threads"});
      rule.threads = int(timing->integer("threads", 0, 4096, 0));
    }
    auto profiles = top.table("profile");
    if (!profiles) return;
    profiles->allow({"quick", "paper"});
    for (const std::string name : {"quick", "paper"}) {
      const auto table = profiles->table(name);
      if (!table) continue;
      TableReader reader = *table;
      reader.allow({"overrides", "reference", "runs", "budget", "committed_references"});
      const toml::table& raw = *toml_.get("profile")->as_table()->get(name)->as_table();
      const Pairs changed = overrides(raw, "overrides", reader);
      const Pairs finer = settings(raw, "reference", reader);
      const int runs = int(reader.integer("runs", 1, 10000, rule.runs));
      const double budget = reader.number("budget", scene::load::not_negative, rule.budget);
      if (reader.has("runs") && budget == 0)
        reader.fail("runs", "has no effect where budget = 0: then the picture is rendered once");
      const bool committed = reader.flag("committed_references", false);
      if (committed && !images()) reader.fail("committed_references", "only pictures have committed references");
      if (committed && !toml_.contains("reference"))
        reader.fail("committed_references", "there is no [reference] that could be committed");
      if (name != experiment_.profile) continue;
      scene_overrides = changed;
      reference_settings = finer;
      if (committed) experiment_.reference.committed = folders_.root / committed_folder;
      rule.runs = runs;
      rule.budget = budget;
    }
  }

  // What makes the rows: its key in the file, and the thing itself.
  const char* component_key() const { return numbers() ? "probe" : images() ? "renderer" : "solver"; }
  const scene::Component& find_component(const std::string& name, const std::string& where) const {
    if (numbers()) return find_probe(name, where);
    if (images()) return find_renderer(name, where);
    return find_solver(name, where);
  }

  // What a row may have for time.
  std::vector<std::string> times() const {
    if (flow()) return {"seconds", "step_seconds", "cell_seconds", "simulated_seconds"};
    return {"seconds", "prepare_seconds", "total_seconds"};
  }

  void check_component(const TableReader& reader, const std::string& name, const Pairs& given) const {
    const scene::Component* component = nullptr;
    try {
      component = &find_component(name, reader.where());
      scene::Settings(component->settings(), given, reader.where() + ": settings");
    } catch (const Error& error) {
      reader.fail(component ? "settings" : component_key(),
                  std::string(error.what()).substr(reader.where().size() + 2));
    }
  }

  // The publications print root mean squares: each table has them beside its relative errors.
  void add_rms_errors() {
    std::vector<std::string>& metrics = experiment_.metrics;
    for (std::size_t i = 0; i < metrics.size(); ++i) {
      const std::string relative = "rel_l2";
      std::string rms = metrics[i];
      const std::size_t at = rms.find(relative);
      if (at == std::string::npos || rms.find("squared") != std::string::npos) continue;
      rms.replace(at, relative.size(), "rmse");
      if (std::find(metrics.begin(), metrics.end(), rms) == metrics.end())
        metrics.insert(metrics.begin() + std::ptrdiff_t(i) + 1, rms);
    }
  }

  // Each metric is a figure of some probe.
  void figures() const {
    std::vector<std::string> known;
    for (const MethodCase& m : experiment_.methods)
      for (const std::string& figure : find_probe(m.renderer, m.name).figures())
        if (std::find(known.begin(), known.end(), figure) == known.end()) known.push_back(figure);
    for (const std::string& metric : experiment_.metrics)
      if (std::find(known.begin(), known.end(), metric) == known.end())
        throw Error(fmt::format("{}: unknown figure '{}', expected one of {}{}", position("metrics"), metric,
                                fmt::join(known, ", "), scene::nearest_hint(metric, known)));
  }

  void reference(const TableReader& top, const Pairs& finer) {
    auto reader = top.table("reference");
    if (!reader) {
      for (const std::string& metric : experiment_.metrics)
        if (images() || needs_reference(parse_flow_metric(metric, position("metrics"))))
          top.fail("metrics", fmt::format("there is {} and no [reference]", metric));
      return;
    }
    reader->allow({component_key(), "settings"});
    experiment_.reference.renderer = reader->text(component_key());
    experiment_.reference.settings = settings(*toml_.get("reference")->as_table(), "settings", *reader);
    for (const auto& [name, value] : finer) experiment_.reference.settings[name] = value;
    check_component(*reader, experiment_.reference.renderer, experiment_.reference.settings);
    if (!experiment_.reference.committed.empty() && !is_reference(find_renderer(experiment_.reference.renderer, "")))
      reader->fail(component_key(),
                   "committed_references = true, but only those of reference/ may be committed: a test renders "
                   "a part of each anew");
  }

  void scenes(const TableReader& top, const Pairs& of_profile) {
    for (auto& [table, reader] : lists(top, "scene")) {
      reader.allow({"name", "file", "overrides", "parameter", "profiles", "sweep"});
      SceneCase scene;
      scene.file = folders_.root / "experiments" / reader.text("file");
      scene.name = reader.name("name", scene.file.stem().string());
      scene.position = scene::load::location(table->source());
      scene.overrides = of_profile;
      for (const auto& [path, value] : overrides(*table, "overrides", reader)) scene.overrides[path] = value;
      if (reader.has("parameter")) scene.parameter = reader.number("parameter", scene::load::any_number);
      const bool wanted = in_profile(*table, reader);
      if (wanted) name_sequences(folders_, experiment_.profile, scene.position, scene.overrides, experiment_.sequences);
      std::vector<SceneCase> cases{scene};
      if (auto sweep = reader.table("sweep")) {
        sweep->allow({"key", "values", "with"});
        cases.clear();
        const std::string key = sweep->text("key");
        const std::vector<double> values = sweep->numbers("values", scene::load::any_number);
        const std::vector<Pairs> along =
            overrides_of_each(*table->get("sweep")->as_table(), "with", values.size(), *sweep);
        for (std::size_t i = 0; i < values.size(); ++i) {
          cases.push_back(scene);
          for (const auto& [path, value] : along[i]) cases.back().overrides[path] = value;
          cases.back().overrides[key] = fmt::format("{}", values[i]);
          cases.back().parameter = values[i];
          cases.back().name = fmt::format("{} {:g}", scene.name, values[i]);
          cases.back().swept_from = scene.name;
          for (const std::string moves : {"frame", "angle"})
            if (key.ends_with("." + moves)) cases.back().of_sequence = moves;
        }
      }
      if (wanted) experiment_.scenes.insert(experiment_.scenes.end(), cases.begin(), cases.end());
    }
    if (numbers() && !top.has("scene")) experiment_.scenes.emplace_back();
    if (experiment_.scenes.empty()) top.fail("", "there is no [[scene]] in this profile");
    if (!experiment_.reference.committed.empty() && !experiment_.sequences.empty())
      top.fail(
          "",
          "committed_references = true, and a scene shows a sequence: its frames are simulated on each machine, so "
          "that a committed film may not be of the same smoke");
  }

  void methods(const TableReader& top) {
    for (auto& [table, reader] : lists(top, "method")) {
      std::vector<std::string> keys{"name", component_key(), "settings", "sweep", "profiles", "scenes"};
      if (images()) keys.insert(keys.end(), {"layer", "picture_only", "count_noise", "moving"});
      reader.allow(keys);
      MethodCase method;
      method.renderer = reader.text(component_key());
      method.name = reader.name("name", method.renderer);
      method.position = scene::load::location(table->source());
      method.settings = settings(*table, "settings", reader);
      if (images()) {
        method.layer = reader.text("layer", experiment_.layer);
        method.picture_only = reader.flag("picture_only", false);
        method.count_noise = reader.flag("count_noise", false);
        if (reader.has("moving")) method.moving = reader.choice("moving", what_may_move());
      }
      method.scenes = strings(*table, "scenes", reader);
      for (const std::string& name : method.scenes) known(reader, "scenes", name, "scene");
      std::vector<MethodCase> cases{method};
      if (auto sweep = reader.table("sweep")) {
        sweep->allow({"key", "values"});
        cases.clear();
        const std::string key = sweep->text("key");
        const toml::array* values = table->get("sweep")->as_table()->get_as<toml::array>("values");
        if (!values || values->empty()) sweep->expected("values", "a list of values");
        for (const toml::node& value : *values) {
          cases.push_back(method);
          cases.back().setting = plain(value);
          cases.back().settings[key] = cases.back().setting;
        }
      }
      if (cases.size() > 1) leave_out_unread(method, cases);
      for (const MethodCase& c : cases) check_component(reader, c.renderer, c.settings);
      if (in_profile(*table, reader)) experiment_.methods.insert(experiment_.methods.end(), cases.begin(), cases.end());
    }
  }

  // A row of a sweep goes without the settings that are not read beside its value, where another row reads them: a rule of upsampling in
  // the row that samples every pixel.
  void leave_out_unread(const MethodCase& method, std::vector<MethodCase>& cases) const {
    std::vector<scene::SettingSpec> specs;
    try {
      specs = find_component(method.renderer, "").settings();
    } catch (const Error&) {
      return;  // check_component says why
    }
    std::vector<Pairs> read;
    for (const MethodCase& c : cases) read.push_back(scene::without_unread(specs, c.settings));
    for (const auto& [name, value] : method.settings)
      if (std::any_of(read.begin(), read.end(), [&](const Pairs& row) { return row.count(name) > 0; }))
        for (std::size_t i = 0; i < cases.size(); ++i)
          if (read[i].count(name) == 0) cases[i].settings.erase(name);
  }

  void plots(const TableReader& top) {
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
        std::vector<std::string> axes = times();
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

  // Each row, picture and plot has a name of its own: one would overwrite the other, and nobody could tell them apart.
  void names_apart() const {
    using Owners = std::map<std::string, std::string>;  // of each file or row: who has it, in words
    const auto claim = [](Owners& owners, const std::string& what, const std::string& name, const std::string& owner,
                          const std::string& position) {
      const auto [found, is_new] = owners.try_emplace(name, owner);
      if (!is_new)
        throw Error(fmt::format("{}: {} '{}' of {} is that of {}, too: expected names that differ in letters or digits",
                                position, what, name, owner, found->second));
    };
    const auto folded = [this](const std::string& name) { return images() ? file_name(name) : name; };
    Owners scenes, plots;
    for (const SceneCase& c : experiment_.scenes) {
      claim(scenes, images() ? "the folder of pictures" : "the name", folded(c.name), fmt::format("scene '{}'", c.name),
            c.position);
      Owners rows;
      if (images() && !experiment_.reference.renderer.empty()) rows["reference"] = "the reference";
      for (const MethodCase& m : experiment_.methods) {
        if (!is_on(m, c)) continue;
        const std::string owner = m.setting.empty() ? fmt::format("method '{}'", m.name)
                                                    : fmt::format("method '{}' with setting '{}'", m.name, m.setting);
        claim(rows, images() ? "the picture" : "the row",
              images() ? picture_name(m.name, m.setting) : m.name + " " + m.setting, owner, m.position);
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

  // A name that gates and the like refer to must exist in some profile; here: in this file.
  void known(const TableReader& reader, const std::string& key, const std::string& value,
             const std::string& list) const {
    std::vector<std::string> names;
    if (list == "metric") {
      if (value.rfind("counter.", 0) == 0) return;
      names = experiment_.metrics;
      for (const std::string& time : times()) names.push_back(time);
      names.push_back("counter.NAME");
    } else if (const toml::array* array = toml_.get_as<toml::array>(list)) {
      for (const toml::node& node : *array) {
        const toml::table& table = *node.as_table();
        const std::string source = list == "scene" ? "file" : component_key();
        const std::string fallback = table[source].value_or(std::string());
        names.push_back(table["name"].value_or(list == "scene" ? fs::path(fallback).stem().string() : fallback));
      }
      if (list == "scene")
        for (const SceneCase& scene : experiment_.scenes) names.push_back(scene.name);
    }
    if (std::find(names.begin(), names.end(), value) == names.end())
      reader.expected(key, fmt::format("one of {}{}", fmt::join(names, ", "), scene::nearest_hint(value, names)));
  }

  // A gate must have a row to judge, and each of its rows a figure.
  void has_figures(const TableReader& reader, const GateCase& gate) const {
    const auto wrong = [&](const std::string& what) {
      reader.fail("", fmt::format("{} in profile {}", what, experiment_.profile));
    };
    const std::vector<std::string> tests = {"objections", "largest_z", "detectable_bias"};
    const std::vector<std::string> of_time = times();
    const bool of_time_or_work =
        gate.metric.starts_with("counter.") || std::find(of_time.begin(), of_time.end(), gate.metric) != of_time.end();
    const bool test = std::find(tests.begin(), tests.end(), gate.metric) != tests.end();
    const auto noisy = [this](const std::string& name) {
      return images() && !name.empty() && find_renderer(name, "gate").monte_carlo();
    };
    const bool noisy_reference = noisy(experiment_.reference.renderer);
    bool found = false;
    for (const SceneCase& c : experiment_.scenes)
      for (const MethodCase& m : experiment_.methods) {
        if (!judges(gate, c.name, m.name, m.setting) || !is_on(m, c)) continue;
        found = true;
        if (of_time_or_work || !images()) continue;
        if (m.picture_only && gate.method.empty()) continue;  // every method that has figures
        if (m.picture_only) wrong(fmt::format("method '{}' is picture_only: it has no {}", m.name, gate.metric));
        if (test && !noisy_reference && !noisy(m.renderer))
          wrong(fmt::format("{} needs noise, and neither '{}' nor the reference has any", gate.metric, m.name));
        if (gate.metric == "wrong" && noisy_reference) wrong("wrong is not defined against a noisy reference");
      }
    if (!found)
      wrong(fmt::format("there is no row of method '{}'{}{}", gate.method,
                        gate.setting.empty() ? "" : fmt::format(" with setting {}", gate.setting),
                        gate.scene.empty() ? "" : fmt::format(" on scene '{}'", gate.scene)));
  }

  void checks(const TableReader& top) {
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
        if (!numbers() || reader.has("scene")) known(reader, "scene", e.scene = reader.text("scene"), "scene");
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

  // Whose speed-up is expected: the table has it, with its interval.
  std::string baseline_of(const TableReader& reader, const ExpectedCase& e) const {
    const std::string baseline = reader.text("baseline");
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

  void check_summary(const TableReader& top) const {
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

  Folders folders_;
  std::string file_;
  toml::table toml_;
  Experiment experiment_;
};

}  // namespace

Experiment read_experiment(const Folders& folders, const std::string& id, const std::string& profile) {
  return Reader(folders, id, profile).read();
}

}  // namespace airlight::experiments
