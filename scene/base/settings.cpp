#include "scene/base/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
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

}  // namespace

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
    for (const auto& [other, values] : spec(name).read_where)
      if (std::find(values.begin(), values.end(), values_.at(other)) == values.end())
        throw Error(fmt::format("{}: {} = {} is not read with {} = {}, expected {} = {}", where, name, text, other,
                                values_.at(other), other, fmt::join(values, " or ")));
}

const SettingSpec& Settings::spec(const std::string& name) const {
  const auto found = std::find_if(specs_.begin(), specs_.end(), [&](const auto& s) { return s.name == name; });
  if (found == specs_.end()) throw std::logic_error("undeclared setting " + name);
  return *found;
}

long long Settings::integer(const std::string& name) const {
  long long value = 0;
  parse_number(values_.at(spec(name).name), value);
  return value;
}

double Settings::real(const std::string& name) const {
  double value = 0;
  parse_number(values_.at(spec(name).name), value);
  return value;
}

bool Settings::flag(const std::string& name) const { return values_.at(spec(name).name) == "true"; }

const std::string& Settings::text(const std::string& name) const { return values_.at(spec(name).name); }

int Settings::place_of_choice(const std::string& name) const {
  const std::vector<std::string>& choices = spec(name).choices;
  return int(std::find(choices.begin(), choices.end(), text(name)) - choices.begin());
}

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
