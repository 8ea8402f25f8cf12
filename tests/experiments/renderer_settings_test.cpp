// Rules for the settings of every renderer and solver: a setting that is not read beside the others is refused, one
// that is read is accepted.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "experiments/application/renderers.h"
#include "experiments/application/solvers.h"
#include "scene/base/error.h"

namespace renderer_settings_test {

using namespace airlight::scene;
using Given = std::map<std::string, std::string>;
using Specs = std::vector<SettingSpec>;

namespace {

const SettingSpec& spec_of(const Specs& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const SettingSpec& s) { return s.name == name; });
}

// Texts that a setting may have, at either side of every bound that conditions of it name.
std::vector<std::string> values_of(const SettingSpec& spec) {
  if (spec.type == SettingSpec::Type::choice) return spec.choices;
  if (spec.type == SettingSpec::Type::flag) return {"true", "false"};
  std::vector<std::string> values;
  for (const double value : {spec.least, 0.0, 0.5, 1.0, 2.0})
    if (value >= spec.least && value <= spec.greatest &&
        (spec.type == SettingSpec::Type::real || value == std::floor(value)))
      values.push_back(fmt::format("{:g}", value));
  return values;
}

// A condition by itself, as scene/base/settings.h states it.
bool holds(const SettingSpec& spec, const std::string& text, const std::vector<std::string>& values) {
  const bool number = spec.type == SettingSpec::Type::integer || spec.type == SettingSpec::Type::real;
  for (const std::string& value : values) {
    if (!number && text == value) return true;
    if (!number) continue;
    const double is = std::stod(text), bound = std::stod(value.substr(value.find_first_not_of("<> ")));
    if (value[0] == '>' ? is > bound : value[0] == '<' ? is < bound : is == bound) return true;
  }
  return false;
}

std::string refusal(const Specs& all, const Given& given) {
  try {
    Settings(all, given);
  } catch (const airlight::Error& error) {
    return error.what();
  }
  return "";
}

// Calls visit() with every combination of values of the settings named, each of which may also be left at its default.
void combine(const Specs& all, std::vector<std::string> names, Given given,
             const std::function<void(const Given&)>& visit) {
  if (names.empty()) {
    if (refusal(all, given).empty()) visit(given);
    return;
  }
  const std::string name = names.back();
  names.pop_back();
  combine(all, names, given, visit);
  for (const std::string& value : values_of(spec_of(all, name))) {
    given[name] = value;
    combine(all, names, given, visit);
  }
}

void check_conditions(const Specs& all, const SettingSpec& spec) {
  std::vector<std::string> others;
  for (const SettingSpec::Others& alternative : spec.read_where)
    for (const auto& [name, values] : alternative) {
      const std::string& other = name;
      CAPTURE(other);
      REQUIRE(std::any_of(all.begin(), all.end(), [&](const SettingSpec& s) { return s.name == other; }));
      if (std::find(others.begin(), others.end(), other) == others.end()) others.push_back(other);
      if (spec_of(all, other).type == SettingSpec::Type::choice)
        for (const std::string& value : values)
          CHECK(std::count(spec_of(all, other).choices.begin(), spec_of(all, other).choices.end(), value) == 1);
    }
  int accepted = 0, refused = 0;
  combine(all, others, {}, [&](const Given& given) {
    const auto text = [&](const std::string& name) {
      const auto found = given.find(name);
      return found == given.end() ? spec_of(all, name).fallback : found->second;
    };
    const auto read = std::find_if(spec.read_where.begin(), spec.read_where.end(), [&](const auto& alternative) {
      return std::all_of(alternative.begin(), alternative.end(), [&](const auto& condition) {
        return holds(spec_of(all, condition.first), text(condition.first), condition.second);
      });
    });
    Given with = given;
    with[spec.name] = spec.fallback;
    CAPTURE(with);
    if (read == spec.read_where.end()) {
      ++refused;
      CHECK_THAT(refusal(all, with),
                 Catch::StartsWith(fmt::format("settings: {} = {} is not read with ", spec.name, spec.fallback)));
      CHECK(without_unread(all, with) == given);
      return;
    }
    ++accepted;
    // A setting on which it depends is read too: a condition names all that leads to it.
    for (const auto& [other, values] : *read) with[other] = text(other);
    CHECK(refusal(all, with) == "");
  });
  CHECK(accepted > 0);
  CHECK(refused > 0);
}

}  // namespace

TEST_CASE("a setting with a condition is accepted where it holds, and refused where it does not", "[settings]") {
  std::vector<const Component*> components;
  for (const auto& renderer : airlight::experiments::all_renderers()) components.push_back(renderer.get());
  for (const auto& solver : airlight::experiments::all_solvers()) components.push_back(solver.get());
  int conditions = 0;
  for (const Component* component : components) {
    const Specs all = component->settings();
    for (const SettingSpec& spec : all) {
      if (spec.read_where.empty()) continue;
      CAPTURE(component->name(), spec.name);
      check_conditions(all, spec);
      ++conditions;
    }
  }
  CHECK(conditions > 100);  // of all of them
}

}  // namespace renderer_settings_test
