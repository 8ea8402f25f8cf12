#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "experiments/application/renderers.h"
#include "experiments/driver/committed_references.h"
#include "experiments/driver/experiment_reader.h"
#include "experiments/driver/sequences.h"
#include "experiments/driver/toml_values.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/read_file.h"
#include "scene/base/settings.h"

namespace airlight::experiments {
using scene::load::TableReader;

ExperimentReader::ExperimentReader(const Folders& folders, const std::string& id, const std::string& profile)
    : folders_(folders) {
  experiment_.id = id;
  experiment_.profile = profile;
  file_ = (folders.root / "experiments" / (id + ".toml")).string();
  toml_ = scene::load::parse_toml(scene::read_whole_file(file_, scene::load::most_toml_bytes), file_);
}

void ExperimentReader::take_over(const TableReader& top) {
  auto reader = top.table("like");
  if (!reader) return;
  reader->allow({"experiment", "without", "device"});
  const bool device = reader->flag("device", false);
  if (device && !kind().draws_pictures()) reader->fail("device", "only renderers have a twin on the device");
  const std::vector<std::string> without = strings(*toml_.get("like")->as_table(), "without", *reader);
  std::set<std::string> left(without.begin(), without.end());
  const std::string id = reader->text("experiment");
  const std::string path = (folders_.root / "experiments" / (id + ".toml")).string();
  if (!std::filesystem::exists(path)) reader->expected("experiment", "an experiment, as group/name");
  toml::table other = scene::load::parse_toml(scene::read_whole_file(path, scene::load::most_toml_bytes), path);
  if (other.contains("like")) reader->expected("experiment", "one that is not like another itself");
  for (const std::string list : {"scene", "method"}) {
    toml::array* theirs = other.get_as<toml::array>(list);
    if (!theirs) continue;
    toml::array* ours = toml_.get_as<toml::array>(list);
    if (!ours) ours = toml_.insert(list, toml::array()).first->second.as_array();
    for (toml::node& node : *theirs) {
      auto* table = node.as_table();
      const std::string name = table ? (*table)["name"].value_or(std::string()) : std::string();
      if (list == "method" && std::find(without.begin(), without.end(), name) != without.end()) {
        left.erase(name);
        continue;
      }
      if (list == "method" && device && table) to_device(*table, name, *reader);
      ours->push_back(std::move(node));
    }
  }
  if (!left.empty()) reader->fail("without", fmt::format("{} has no method '{}'", id, *left.begin()));
}

void ExperimentReader::to_device(toml::table& method, const std::string& name, const TableReader& reader) const {
  const std::string key = kind().component_key();
  const std::string twin = method[key].value_or(std::string()) + "_gpu";
  try {
    kind().find_component(twin, "");
  } catch (const Error&) {
    reader.fail("device",
                fmt::format("there is no renderer '{}': leave out method '{}' (without = [...])", twin, name));
  }
  method.insert_or_assign(key, twin);
}

Experiment ExperimentReader::read() {
  TableReader top(toml_, "");
  std::vector<std::string> kinds;
  experiment_.kind = all_kinds().front();
  for (const ExperimentKind* kind : all_kinds()) {
    kinds.push_back(kind->name());
    if (toml_["kind"].value_or(std::string()) == kind->name()) experiment_.kind = kind;
  }
  std::vector<std::string> keys{"kind",   "title",  "paper", "about",   "summary",   "metrics",  "in_tests",
                                "scene",  "method", "plot",  "gate",    "speed_up",  "expected", "profile",
                                "timing", "like",   "claim", "erratum", "conclusion"};
  const std::vector<std::string> of_kind = kind().keys();
  keys.insert(keys.end(), of_kind.begin(), of_kind.end());
  top.allow(keys);
  take_over(top);
  top.choice("kind", kinds, kinds.front());
  experiment_.title = top.text("title");
  experiment_.paper = top.text("paper", "");
  experiment_.about = top.text("about", "");
  experiment_.summary = top.text("summary", "");
  experiment_.in_tests = top.flag("in_tests", false);
  kind().read(top, experiment_);
  experiment_.metrics = strings(toml_, "metrics", top);
  Pairs overrides, reference_settings;
  profile(top, overrides, reference_settings);
  scenes(top, overrides);
  if (std::find(of_kind.begin(), of_kind.end(), "reference") != of_kind.end()) reference(top, reference_settings);
  methods(top);
  kind().check_metrics(experiment_, position("metrics"));
  plots(top);
  names_apart();
  checks(top);
  if (top.has("summary")) check_summary(top);
  claims(top);
  return experiment_;
}

std::string ExperimentReader::position(const std::string& key) const {
  const toml::node* node = toml_.get(key);
  return scene::load::location(node ? node->source() : toml_.source());
}

std::vector<std::pair<const toml::table*, TableReader>> ExperimentReader::lists(const TableReader& top,
                                                                                const std::string& key) const {
  return lists(toml_, top, key);
}

std::vector<std::pair<const toml::table*, TableReader>> ExperimentReader::lists(const toml::table& in,
                                                                                const TableReader& reader,
                                                                                const std::string& key) {
  std::vector<std::pair<const toml::table*, TableReader>> all;
  if (!reader.has(key)) return all;
  const toml::array* array = in.get(key)->as_array();
  if (!array) reader.expected(key, fmt::format("tables [[{}]]", key));
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::table* table = array->get_as<toml::table>(i);
    if (!table) reader.expected(key, fmt::format("tables [[{}]]", key));
    all.emplace_back(table, TableReader(*table, fmt::format("{} {}", key, i)));
  }
  return all;
}

bool ExperimentReader::in_profile(const toml::table& table, const TableReader& reader) const {
  const auto profiles = strings(table, "profiles", reader);
  for (const std::string& p : profiles)
    if (p != "quick" && p != "paper") reader.expected("profiles", "a list of \"quick\" and \"paper\"");
  return profiles.empty() || std::find(profiles.begin(), profiles.end(), experiment_.profile) != profiles.end();
}

void ExperimentReader::profile(const TableReader& top, Pairs& scene_overrides, Pairs& reference_settings) {
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
    if (committed && !kind().draws_pictures())
      reader.fail("committed_references", "only pictures have committed references");
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

void ExperimentReader::check_component(const TableReader& reader, const std::string& name, const Pairs& given) const {
  const scene::Component* component = nullptr;
  try {
    component = &kind().find_component(name, reader.where());
    scene::Settings(component->settings(), given, reader.where() + ": settings");
  } catch (const Error& error) {
    reader.fail(component ? "settings" : kind().component_key(),
                std::string(error.what()).substr(reader.where().size() + 2));
  }
}

void ExperimentReader::reference(const TableReader& top, const Pairs& finer) {
  auto reader = top.table("reference");
  if (!reader) {
    for (const std::string& metric : experiment_.metrics)
      if (kind().needs_reference(metric, position("metrics")))
        top.fail("metrics", fmt::format("there is {} and no [reference]", metric));
    return;
  }
  std::vector<std::string> keys{kind().component_key(), "settings"};
  if (kind().draws_pictures()) keys.push_back("instead");
  reader->allow(keys);
  const toml::table& table = *toml_.get("reference")->as_table();
  read_reference(*reader, table, finer, experiment_.reference);
  if (!kind().draws_pictures()) return;
  for (auto& [other, of_some] : lists(table, *reader, "instead")) {
    of_some.allow({"scenes", kind().component_key(), "settings"});
    ReferenceCase instead;
    instead.committed = experiment_.reference.committed;
    read_reference(of_some, *other, {}, instead);
    for (const std::string& name : strings(*other, "scenes", of_some)) {
      known(of_some, "scenes", name, "scene");
      for (SceneCase& c : experiment_.scenes)
        if (c.name == name || c.swept_from == name) c.reference = instead;
    }
  }
}

void ExperimentReader::read_reference(const TableReader& reader, const toml::table& table, const Pairs& finer,
                                      ReferenceCase& to) const {
  to.renderer = reader.text(kind().component_key());
  to.settings = settings(table, "settings", reader);
  for (const auto& [name, value] : finer) to.settings[name] = value;
  check_component(reader, to.renderer, to.settings);
  if (!to.committed.empty() && !is_reference(find_renderer(to.renderer, "")))
    reader.fail(kind().component_key(),
                "committed_references = true, but only those of reference/ may be committed: a test renders "
                "a part of each anew");
}

void ExperimentReader::scenes(const TableReader& top, const Pairs& of_profile) {
  for (auto& [table, reader] : lists(top, "scene")) {
    std::vector<std::string> keys{"name", "file", "overrides", "parameter", "profiles", "sweep"};
    const std::vector<std::string> of_kind = kind().scene_keys();
    keys.insert(keys.end(), of_kind.begin(), of_kind.end());
    reader.allow(keys);
    SceneCase scene;
    kind().read_scene(reader, scene);
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
  if (!kind().needs_scene() && !top.has("scene")) experiment_.scenes.emplace_back();
  if (experiment_.scenes.empty()) top.fail("", "there is no [[scene]] in this profile");
  if (!experiment_.reference.committed.empty() && !experiment_.sequences.empty())
    top.fail("",
             "committed_references = true, and a scene shows a sequence: its frames are simulated on each machine, so "
             "that a committed film may not be of the same smoke");
}

void ExperimentReader::methods(const TableReader& top) {
  for (auto& [table, reader] : lists(top, "method")) {
    std::vector<std::string> keys{"name", kind().component_key(), "settings", "sweep", "profiles", "scenes"};
    const std::vector<std::string> of_kind = kind().method_keys();
    keys.insert(keys.end(), of_kind.begin(), of_kind.end());
    reader.allow(keys);
    MethodCase method;
    method.renderer = reader.text(kind().component_key());
    method.name = reader.name("name", method.renderer);
    method.position = scene::load::location(table->source());
    method.settings = settings(*table, "settings", reader);
    kind().read_method(reader, experiment_, method);
    method.scenes = strings(*table, "scenes", reader);
    for (const std::string& name : method.scenes) known(reader, "scenes", name, "scene");
    // Tables of a method's own settings beside its renderer's: what becomes of the case when one of them is known.
    struct Group {
      std::string name;
      std::function<void(MethodCase&, const Pairs&, const std::string& position)> apply;
      Pairs values;
      std::string position;
    };
    std::vector<Group> groups = {
        {"convert",
         [](auto& c, auto& given, auto& where) { c.convert = scene::read_conversion(given, where); },
         {},
         {}},
        {"moving", [](auto& c, auto& given, auto& where) { c.moving = read_moving(given, where); }, {}, {}}};
    for (Group& group : groups) {
      if (!table->contains(group.name)) continue;
      group.values = settings(*table, group.name, reader);
      group.position = scene::load::location(table->get(group.name)->source());
      group.apply(method, group.values, group.position);
    }
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
        bool grouped = false;
        for (Group& group : groups) {
          if (group.values.empty() || !key.starts_with(group.name + ".")) continue;
          group.values[key.substr(group.name.size() + 1)] = cases.back().setting;
          group.apply(cases.back(), group.values, group.position);
          grouped = true;
        }
        if (!grouped) cases.back().settings[key] = cases.back().setting;
      }
    }
    if (cases.size() > 1) leave_out_unread(method, cases);
    for (const MethodCase& c : cases) check_component(reader, c.renderer, c.settings);
    if (in_profile(*table, reader)) experiment_.methods.insert(experiment_.methods.end(), cases.begin(), cases.end());
  }
}

void ExperimentReader::leave_out_unread(const MethodCase& method, std::vector<MethodCase>& cases) const {
  std::vector<scene::SettingSpec> specs;
  try {
    specs = kind().find_component(method.renderer, "").settings();
  } catch (const Error&) {
    return;  // check_component says why
  }
  std::vector<Pairs> read;
  for (const MethodCase& c : cases) read.push_back(scene::without_unread(specs, c.settings));
  for (const auto& setting : method.settings) {
    const std::string& name = setting.first;
    if (std::any_of(read.begin(), read.end(), [&](const Pairs& row) { return row.count(name) > 0; }))
      for (std::size_t i = 0; i < cases.size(); ++i)
        if (read[i].count(name) == 0) cases[i].settings.erase(name);
  }
}

Experiment read_experiment(const Folders& folders, const std::string& id, const std::string& profile) {
  return ExperimentReader(folders, id, profile).read();
}

}  // namespace airlight::experiments
