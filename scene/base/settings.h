// Settings of a renderer: declared once, checked once, printed into every result.
#pragma once
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace airlight::scene {

struct SettingSpec {
  enum class Type { integer, real, flag, choice };
  std::string name;
  Type type;
  std::string fallback;  // the default, as text
  std::string doc;       // one line, with unit
  double least = 0;      // inclusive range of integer and real
  double greatest = 1e300;
  std::vector<std::string> choices = {};  // of a choice
  // Values of other settings beside which this one is read, by their names. For a number also a bound: "> 0", "< 1".
  using Others = std::map<std::string, std::vector<std::string>>;
  // Alternatives: the setting is read where each of the others in one of them has one of its values; always where there are none.
  std::vector<Others> read_where = {};

  // Adds to the last alternative.
  SettingSpec& where(std::string other, std::vector<std::string> values) {
    if (read_where.empty()) read_where.emplace_back();
    read_where.back().emplace(std::move(other), std::move(values));
    return *this;
  }
  // Begins another alternative.
  SettingSpec& or_where(std::string other, std::vector<std::string> values) {
    read_where.emplace_back();
    return where(std::move(other), std::move(values));
  }
};
// The condition under which a setting is read: "variant = S and prt = true, or K > 8"; empty: always.
std::string read_condition(const SettingSpec&);

// `fallback` as text keeps the spelling that canonical() prints.
inline SettingSpec integer_setting(std::string name, std::string fallback, double least, double greatest,
                                   std::string doc) {
  return {std::move(name), SettingSpec::Type::integer, std::move(fallback), std::move(doc), least, greatest};
}
inline SettingSpec real_setting(std::string name, std::string fallback, double least, double greatest,
                                std::string doc) {
  return {std::move(name), SettingSpec::Type::real, std::move(fallback), std::move(doc), least, greatest};
}
inline SettingSpec flag_setting(std::string name, bool fallback, std::string doc) {
  return {std::move(name), SettingSpec::Type::flag, fallback ? "true" : "false", std::move(doc), 0, 0};
}
inline SettingSpec choice_setting(std::string name, std::string fallback, std::vector<std::string> choices,
                                  std::string doc) {
  return {std::move(name), SettingSpec::Type::choice, std::move(fallback), std::move(doc), 0, 0, std::move(choices)};
}

// Accepted texts of a choice, and the value of each.
template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

template <class Value>
SettingSpec choice_setting(const std::string& name, const std::type_identity_t<Value>& fallback,
                           const Choices<Value>& choices, std::string doc) {
  std::string said;
  std::vector<std::string> texts;
  for (const auto& [text, value] : choices) {
    texts.push_back(text);
    if (value == fallback) said = text;
  }
  if (said.empty()) throw std::logic_error("no choice of " + name + " is its default");
  return choice_setting(name, said, std::move(texts), std::move(doc));
}

// Values for all specs of one renderer.
class Settings {
 public:
  // Throws Error for an unknown name (with the nearest valid one), a wrong type, a value out of range, and for a setting that
  // is not read beside the others. `where` begins the message.
  Settings(std::vector<SettingSpec> specs, const std::map<std::string, std::string>& given,
           const std::string& where = "settings");

  long long integer(const std::string& name) const;
  double real(const std::string& name) const;
  bool flag(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  template <class Value>
  Value choice(const std::string& name, const Choices<Value>& choices) const {
    for (const auto& [said, value] : choices)
      if (said == text(name)) return value;
    throw std::logic_error("the choices of " + name + " are others");
  }

  // The values given for these specs, without defaults: the settings of a renderer among those of a probe.
  std::map<std::string, std::string> given(const std::vector<SettingSpec>&) const;

  // "name=value name=value ..." of all settings in the order of the specs: part of cache keys and metadata.
  std::string canonical() const;

 private:
  const SettingSpec& spec(const std::string& name) const;
  std::vector<SettingSpec> specs_;
  std::map<std::string, std::string> given_, values_;
};

// Without the settings that nothing reads beside the others.
std::map<std::string, std::string> without_unread(const std::vector<SettingSpec>&,
                                                  std::map<std::string, std::string> given);

// Settings bound to the variables of a structure. One function lists both, and is used to declare the settings and to read them:
//   void bind(SettingBinder& b, Options& o) { b.integer("levels", o.levels, 0, 20, "of the decomposition"); }
// Defaults are what the variables hold before: member initialisers.
class SettingBinder {
 public:
  explicit SettingBinder(const Settings* values) : values_(values) {}  // null: only lists

  template <class Integer>
  SettingSpec& integer(const std::string& name, Integer& variable, double least, double greatest, std::string doc) {
    specs.push_back(integer_setting(name, std::to_string(variable), least, greatest, std::move(doc)));
    if (values_) variable = Integer(values_->integer(name));
    return specs.back();
  }
  SettingSpec& real(const std::string& name, double& variable, double least, double greatest, std::string doc);
  SettingSpec& flag(const std::string& name, bool& variable, std::string doc);
  template <class Value>
  SettingSpec& choice(const std::string& name, Value& variable, const Choices<std::type_identity_t<Value>>& choices,
                      std::string doc) {
    specs.push_back(choice_setting<Value>(name, variable, choices, std::move(doc)));
    if (values_) variable = values_->choice<Value>(name, choices);
    return specs.back();
  }

  std::vector<SettingSpec> specs;

 private:
  const Settings* values_;
};

template <class Options>
std::vector<SettingSpec> list_settings(void (*bind)(SettingBinder&, Options&),
                                       std::type_identity_t<Options> defaults = {}) {
  SettingBinder binder(nullptr);
  bind(binder, defaults);
  return std::move(binder.specs);
}

template <class Options>
Options read_settings(void (*bind)(SettingBinder&, Options&), const Settings& values) {
  Options options{};
  SettingBinder binder(&values);
  bind(binder, options);
  return options;
}

// A candidate that begins with `word`, else the one with the smallest edit distance; empty if there are none.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace airlight::scene
