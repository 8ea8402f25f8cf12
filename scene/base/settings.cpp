#include "scene/base/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>

#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/printable.h"

namespace airlight::scene {
namespace {

constexpr std::size_t most = 100;  // of a word from outside that is compared, or shown

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t up = row[j];
      row[j] = std::min({up + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = up;
    }
  }
  return row.back();
}

// A word that was not typed to its end.
bool is_beginning(const std::string& word, const std::string& candidate) {
  return !word.empty() && candidate.starts_with(word);
}

template <class T>
bool parse_number(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  return code == std::errc() && stop == end;
}

void check_range(const SettingSpec& spec, double value, const std::string& where) {
  if (!(value >= spec.least && value <= spec.greatest))
    throw Error(fmt::format("{}: {} = {} is out of range, expected {} to {}", where, spec.name, value, spec.least,
                            spec.greatest));
}

void check(const SettingSpec& spec, const std::string& text, const std::string& where) {
  using Type = SettingSpec::Type;
  if (spec.type == Type::integer) {
    long long value = 0;
    if (!parse_number(text, value))
      throw Error(fmt::format("{}: {} = '{}', expected an integer", where, spec.name, printable(text, most)));
    check_range(spec, double(value), where);
  } else if (spec.type == Type::real) {
    double value = 0;
    if (!parse_number(text, value) || std::isnan(value))
      throw Error(fmt::format("{}: {} = '{}', expected a number", where, spec.name, printable(text, most)));
    check_range(spec, value, where);
  } else if (spec.type == Type::flag) {
    if (text != "true" && text != "false")
      throw Error(fmt::format("{}: {} = '{}', expected true or false", where, spec.name, printable(text, most)));
  } else if (std::find(spec.choices.begin(), spec.choices.end(), text) == spec.choices.end()) {
    throw Error(fmt::format("{}: {} = '{}', expected one of {}{}", where, spec.name, printable(text, most),
                            fmt::join(spec.choices, ", "), nearest_hint(text, spec.choices)));
  }
}

double number(const std::string& text) {
  double value = 0;
  parse_number(text, value);
  return value;
}

bool is_bound(const std::string& value) { return value.starts_with("> ") || value.starts_with("< "); }

// Whether the text of a setting is one of the values that a condition names.
bool is_among(const SettingSpec& spec, const std::string& text, const std::vector<std::string>& values) {
  using Type = SettingSpec::Type;
  const bool is_number = spec.type == Type::integer || spec.type == Type::real;
  return std::any_of(values.begin(), values.end(), [&](const std::string& value) {
    if (!is_number) return text == value;
    if (!is_bound(value)) return number(text) == number(value);
    const double bound = number(value.substr(2));
    return value[0] == '>' ? number(text) > bound : number(text) < bound;
  });
}

std::string condition_text(const std::string& other, const std::vector<std::string>& values) {
  return fmt::format("{} {}{}", other, is_bound(values.front()) ? "" : "= ", fmt::join(values, " or "));
}

const SettingSpec& find_spec(const std::vector<SettingSpec>& specs, const std::string& name) {
  const auto found = std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.name == name; });
  if (found == specs.end()) throw std::logic_error("undeclared setting " + name);
  return *found;
}

// Beside these values, given ones or else defaults: the conditions that do not hold, as they are and as each alternative expects them.
// Nothing where the setting is read.
struct Unread {
  std::vector<std::string> found, expected;
};
Unread why_unread(const std::vector<SettingSpec>& specs, const SettingSpec& spec,
                  const std::map<std::string, std::string>& given) {
  Unread result;
  const auto add = [](std::vector<std::string>& list, std::string text) {
    if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(std::move(text));
  };
  for (const SettingSpec::Others& alternative : spec.read_where) {
    std::vector<std::string> expected;
    for (const auto& [name, values] : alternative) {
      const SettingSpec& other = find_spec(specs, name);
      const auto value = given.find(name);
      const std::string& text = value == given.end() ? other.fallback : value->second;
      if (is_among(other, text, values)) continue;
      add(result.found, name + " = " + text);
      expected.push_back(condition_text(name, values));
    }
    if (expected.empty()) return {};
    add(result.expected, fmt::format("{}", fmt::join(expected, " and ")));
  }
  return result;
}

// Shortest text that reads back as this number: 1e-4, not 1e-04.
std::string text_of(double value) {
  std::array<char, 32> room;
  std::string text(room.data(), std::to_chars(room.data(), room.data() + room.size(), value).ptr);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  const std::string sign = text[e + 1] == '-' ? "-" : "";
  return text.substr(0, e + 1) + sign + text.substr(text.find_first_not_of("+-0", e + 1));
}

}  // namespace

std::string read_condition(const SettingSpec& spec) {
  std::vector<std::string> alternatives;
  for (const SettingSpec::Others& alternative : spec.read_where) {
    std::vector<std::string> all;
    for (const auto& [other, values] : alternative) all.push_back(condition_text(other, values));
    alternatives.push_back(fmt::format("{}", fmt::join(all, " and ")));
  }
  return fmt::format("{}", fmt::join(alternatives, ", or "));
}

std::map<std::string, std::string> without_unread(const std::vector<SettingSpec>& specs,
                                                  std::map<std::string, std::string> given) {
  const std::map<std::string, std::string> all = given;
  for (const SettingSpec& spec : specs)
    if (!why_unread(specs, spec, all).found.empty()) given.erase(spec.name);
  return given;
}

SettingSpec& SettingBinder::real(const std::string& name, double& variable, double least, double greatest,
                                 std::string doc) {
  specs.push_back(real_setting(name, text_of(variable), least, greatest, std::move(doc)));
  if (values_) variable = values_->real(name);
  return specs.back();
}

SettingSpec& SettingBinder::flag(const std::string& name, bool& variable, std::string doc) {
  specs.push_back(flag_setting(name, variable, std::move(doc)));
  if (values_) variable = values_->flag(name);
  return specs.back();
}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string start = word.substr(0, most);
  const auto distance = [&](const std::string& candidate) {
    return std::pair(!is_beginning(start, candidate), edit_distance(start, candidate));
  };
  const auto best = std::min_element(candidates.begin(), candidates.end(),
                                     [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return best == candidates.end() ? std::string() : *best;
}

std::string nearest_hint(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string start = word.substr(0, most), best = nearest(start, candidates);
  const std::size_t distance = edit_distance(start, best);
  const bool near = distance <= 1 || 2 * distance <= std::max(start.size(), best.size()) || is_beginning(start, best) ||
                    start.starts_with(best);
  return best.empty() || !near ? "" : fmt::format(" (nearest: {})", best);
}

Settings::Settings(std::vector<SettingSpec> specs, const std::map<std::string, std::string>& given,
                   const std::string& where)
    : specs_(std::move(specs)), given_(given) {
  std::vector<std::string> names;
  for (const SettingSpec& s : specs_) {
    names.push_back(s.name);
    values_[s.name] = s.fallback;
  }
  for (const auto& [name, text] : given) {
    const auto spec =
        std::find_if(specs_.begin(), specs_.end(), [&, &name = name](const auto& s) { return s.name == name; });
    if (spec == specs_.end())
      throw Error(fmt::format("{}: unknown setting '{}', expected one of {}{}", where, printable(name, most),
                              fmt::join(names, ", "), nearest_hint(name, names)));
    check(*spec, text, where);
    values_[name] = text;
  }
  for (const auto& [name, text] : given)
    if (const Unread why = why_unread(specs_, spec(name), given); !why.found.empty())
      throw Error(fmt::format("{}: {} = {} is not read with {}, expected {}", where, name, text,
                              fmt::join(why.found, " and "), fmt::join(why.expected, ", or ")));
}

const SettingSpec& Settings::spec(const std::string& name) const { return find_spec(specs_, name); }

long long Settings::integer(const std::string& name) const {
  long long value = 0;
  parse_number(values_.at(spec(name).name), value);
  return value;
}

double Settings::real(const std::string& name) const { return number(text(name)); }

bool Settings::flag(const std::string& name) const { return values_.at(spec(name).name) == "true"; }

const std::string& Settings::text(const std::string& name) const { return values_.at(spec(name).name); }

std::map<std::string, std::string> Settings::given(const std::vector<SettingSpec>& specs) const {
  std::map<std::string, std::string> some;
  for (const SettingSpec& spec : specs)
    if (const auto found = given_.find(spec.name); found != given_.end()) some.insert(*found);
  return some;
}

std::string Settings::canonical() const {
  std::vector<std::string> parts;
  for (const SettingSpec& s : specs_) parts.push_back(s.name + "=" + values_.at(s.name));
  return fmt::format("{}", fmt::join(parts, " "));
}

}  // namespace airlight::scene
