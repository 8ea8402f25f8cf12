// Settings of a renderer: declared once, checked once, printed into every result.
#pragma once
#include <map>
#include <string>
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
  // The setting is read only where each of these others has one of the values; everywhere where this is empty.
  std::map<std::string, std::vector<std::string>> read_where = {};

  SettingSpec where(std::string other, std::vector<std::string> values) && {
    read_where.emplace(std::move(other), std::move(values));
    return std::move(*this);
  }
};

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
  // Of a choice: the enumerator with the place of its text among the choices.
  template <class Enum>
  Enum choice(const std::string& name) const {
    return Enum(place_of_choice(name));
  }

  // What was given of these specs, without defaults: the settings of a renderer among those of a probe.
  std::map<std::string, std::string> given(const std::vector<SettingSpec>&) const;

  // "name=value name=value ..." of all settings in the order of the specs: part of cache keys and metadata.
  std::string canonical() const;

 private:
  int place_of_choice(const std::string& name) const;
  const SettingSpec& spec(const std::string& name) const;
  std::vector<SettingSpec> specs_;
  std::map<std::string, std::string> given_, values_;
};

// A candidate that begins with `word`, else the one with the smallest edit distance; empty if there are none.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace airlight::scene
