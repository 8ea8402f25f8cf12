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
};

// Values for all specs of one renderer.
class Settings {
 public:
  // Throws Error for an unknown name (with the nearest valid one), a wrong type, a value out of range. `where` begins
  // the message.
  Settings(std::vector<SettingSpec> specs, const std::map<std::string, std::string>& given,
           const std::string& where = "settings");

  long long integer(const std::string& name) const;
  double real(const std::string& name) const;
  bool flag(const std::string& name) const;
  const std::string& text(const std::string& name) const;

  // "name=value name=value ..." of all settings in the order of the specs: part of cache keys and metadata.
  std::string canonical() const;

 private:
  const SettingSpec& spec(const std::string& name) const;
  std::vector<SettingSpec> specs_;
  std::map<std::string, std::string> values_;
};

// The candidate with the smallest edit distance to `word`; empty if there are none.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace airlight::scene
