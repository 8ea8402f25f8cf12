#include "experiments/authoring/operation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/base/settings.h"

namespace airlight::experiments::authoring {
namespace {

using nlohmann::json;

// A value as the author wrote it, on one line and cut.
std::string written(const json& value) {
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

constexpr std::size_t most_points = 100'000;
constexpr int most_levels = 16;  // printing and freeing are recursive

}  // namespace

Operation::Operation(const std::string& line, std::string where) : where_(std::move(where)) {
  std::vector<std::set<std::string>> keys;
  std::string twice;
  const auto watch = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > most_levels)
      throw Error(fmt::format("{}: found lists in more than {} levels, expected fewer", where_, most_levels));
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second && twice.empty())
      twice = parsed.get<std::string>();
    return true;
  };
  try {
    json_ = json::parse(line, watch);
  } catch (const json::exception& e) {
    std::string what = e.what();  // "[json.exception.parse_error.101] parse error at line 1, column 5: ..."
    what = what.substr(what.find("] ") == std::string::npos ? 0 : what.find("] ") + 2);
    throw Error(fmt::format("{}: not JSON: {}, expected an object on one line", where_, scene::printable(what, 200)));
  }
  if (!json_.is_object())
    throw Error(fmt::format("{}: found {}, expected an object {{\"op\": ...}}", where_, written(json_)));
  if (!twice.empty())
    throw Error(fmt::format("{}: key '{}' is there twice, expected once", where_, scene::printable(twice, 200)));
}

std::string Operation::name(const std::vector<std::string>& choices) {
  std::string name = choice("op", choices);
  where_ += ": " + name;
  return name;
}

void Operation::allow(std::vector<std::string> keys) const {
  for (const auto& [key, value] : json_.items()) {
    if (key == "op" || std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    fail(fmt::format("unknown key '{}', expected one of {}{}", scene::printable(key, 200), fmt::join(keys, ", "),
                     scene::nearest_hint(key, keys)));
  }
}

void Operation::expected(const std::string& key, const std::string& expected) const {
  fail(fmt::format("{} = {}, expected {}", key, written(json_.at(key)), expected));
}

void Operation::fail(const std::string& message) const { throw Error(fmt::format("{}: {}", where_, message)); }

const json& Operation::require(const std::string& key, const std::string& what) const {
  const auto found = json_.find(key);
  if (found == json_.end()) fail(fmt::format("missing key '{}', expected {}", key, what));
  return *found;
}

std::string Operation::one_of(const std::vector<std::string>& keys) const {
  std::vector<std::string> there;
  for (const std::string& key : keys)
    if (has(key)) there.push_back(key);
  if (there.size() != 1)
    fail(fmt::format("found {} of the keys {}, expected exactly one", there.size(), fmt::join(keys, ", ")));
  return there.front();
}

double Operation::finite(const json& value, const std::string& key, const std::string& what) const {
  if (!value.is_number() || !std::isfinite(value.get<double>())) expected(key, what);
  return value.get<double>();
}

double Operation::number(const std::string& key, const scene::load::Range& range,
                         std::optional<double> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const double value = finite(require(key, range.words()), key, range.words());
  if (!range.contains(value)) expected(key, range.words());
  return value;
}

long long Operation::integer(const std::string& key, long long least, long long greatest,
                             std::optional<long long> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string words = fmt::format("an integer from {} to {}", least, greatest);
  const json& value = require(key, words);
  const bool fits = value.is_number_unsigned() ? value.get<unsigned long long>() <= (unsigned long long)(greatest)
                                               : value.is_number_integer();
  if (!fits || value.get<long long>() < least || value.get<long long>() > greatest) expected(key, words);
  return value.get<long long>();
}

std::string Operation::text(const std::string& key, std::optional<std::string> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const json& value = require(key, "a text");
  if (!value.is_string()) expected(key, "a text");
  return value.get<std::string>();
}

std::string Operation::choice(const std::string& key, const std::vector<std::string>& choices,
                              std::optional<std::string> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string words = fmt::format("one of {}", fmt::join(choices, ", "));
  const json& value = require(key, words);
  if (!value.is_string()) expected(key, words);
  std::string found = value.get<std::string>();
  if (std::find(choices.begin(), choices.end(), found) == choices.end())
    expected(key, fmt::format("{}{}", words, scene::nearest_hint(found, choices)));
  return found;
}

std::vector<double> Operation::numbers(const std::string& key, std::size_t length) const {
  const std::string words = fmt::format("a list of {} finite numbers", length);
  const json& value = require(key, words);
  if (!value.is_array() || value.size() != length) expected(key, words);
  std::vector<double> out;
  for (const json& item : value) out.push_back(finite(item, key, words));
  return out;
}

Vec3 Operation::vector(const std::string& key, std::optional<Vec3> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const auto v = numbers(key, 3);
  return {v[0], v[1], v[2]};
}

Vec3 Operation::direction(const std::string& key, std::optional<Vec3> fallback) const {
  const Vec3 v = vector(key, std::move(fallback));
  const double length = v.stableNorm();
  if (!(length > 0) || !std::isfinite(length)) expected(key, "a direction of any length but zero");
  return (v / length).normalized();
}

Rgb Operation::color(const std::string& key) const {
  if (!has(key)) return Rgb::Ones();
  const std::string words = "a number in [0, 1], or three of them";
  const json& value = json_.at(key);
  Rgb color;
  if (value.is_array() && value.size() == 3)
    for (int i = 0; i < 3; ++i) color[i] = finite(value[i], key, words);
  else
    color = Rgb::Constant(finite(value, key, words));
  if (!(color >= 0).all() || !(color <= 1).all()) expected(key, words);
  return color;
}

std::vector<std::vector<double>> Operation::points(const std::string& key, std::size_t length) const {
  const std::string words = fmt::format("a list of 1 to {} points of {} finite numbers", most_points, length);
  const json& value = require(key, words);
  if (!value.is_array() || value.empty() || value.size() > most_points) expected(key, words);
  std::vector<std::vector<double>> out;
  for (const json& point : value) {
    if (!point.is_array() || point.size() != length) expected(key, words);
    out.emplace_back();
    for (const json& item : point) out.back().push_back(finite(item, key, words));
  }
  return out;
}

std::vector<long long> Operation::integers(const std::string& key) const {
  const std::string words = "a list of integers";
  const json& value = require(key, words);
  if (!value.is_array()) expected(key, words);
  std::vector<long long> out;
  for (const json& item : value) {
    if (!item.is_number_integer()) expected(key, words);
    out.push_back(item.get<long long>());
  }
  return out;
}

std::optional<Operation> Operation::table(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  if (!json_.at(key).is_object()) expected(key, "an object");
  return Operation(json_.at(key), where_ + ": " + key, 0);
}

void for_each_operation(const std::string& path, const std::function<void()>& check,
                        const std::function<bool(Operation, int line)>& body) {
  const std::string content = scene::read_whole_file(path);
  int number = 0;
  bool going_on = true;
  for (std::size_t begin = 0; going_on && begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string line = content.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::size_t text = line.find_first_not_of(" \t\r");
    if (text == std::string::npos || line[text] == '#') continue;
    check();
    const std::string where = fmt::format("{}:{}", path, number);
    at_operation(where, [&] { going_on = body(Operation(line, where), number); });
  }
}

void at_operation(const std::string& where, const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& e) {
    // An operation's own error messages do not know the position in the script.
    const std::string what = e.what();
    if (what.compare(0, where.size(), where) == 0) throw;
    throw Error(fmt::format("{}: {}", where, what), e.exit_code());
  }
}

}  // namespace airlight::experiments::authoring
