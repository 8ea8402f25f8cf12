#include "scene/load/table_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/printable.h"
#include "scene/base/settings.h"
#include "scene/load/overrides.h"
#include "scene/load/ranges.h"

namespace airlight::scene::load {
namespace {

std::string prefix(const std::string& where) { return where.empty() ? "" : where + ": "; }

}  // namespace

TableReader::TableReader(const toml::table& table, std::string where) : table_(&table), where_(std::move(where)) {}

void TableReader::allow(std::vector<std::string> keys) {
  keys_ = std::move(keys);
  for (const auto& [key, value] : *table_) {
    const std::string name(key.str());
    if (std::find(keys_.begin(), keys_.end(), name) != keys_.end()) continue;
    const bool from_override = value.source().path && is_override(*value.source().path);
    throw Error(fmt::format("{}: {}unknown key '{}', expected one of {}{}",
                            location(from_override ? value.source() : key.source()), prefix(where_),
                            printable(name, 100), fmt::join(keys_, ", "), nearest_hint(name, keys_)));
  }
}

std::string TableReader::type(const std::vector<std::string>& choices, std::optional<std::string> fallback) {
  keys_ = {"type"};
  return choice("type", choices, std::move(fallback));
}

const toml::node* TableReader::find(const std::string& key) const {
  if (std::find(keys_.begin(), keys_.end(), key) == keys_.end())
    throw std::logic_error("key '" + key + "' is read but not allowed");
  return table_->get(key);
}

const toml::node& TableReader::require(const std::string& key, const std::string& what) const {
  const toml::node* node = find(key);
  if (!node) fail("", fmt::format("missing key '{}', expected {}", key, what));
  return *node;
}

void TableReader::wrong(const toml::node& node, const std::string& name, const std::string& expected) const {
  throw Error(fmt::format("{}: {}{} = {}, expected {}", location(node.source()), prefix(where_), name, written(node),
                          expected));
}

void TableReader::expected(const std::string& key, const std::string& expected) const {
  wrong(require(key, expected), key, expected);
}

void TableReader::fail(const std::string& key, const std::string& message) const {
  const toml::node* node = key.empty() ? nullptr : find(key);
  throw Error(fmt::format("{}: {}{}", location(node ? node->source() : table_->source()), prefix(where_), message));
}

bool TableReader::has(const std::string& key) const { return find(key) != nullptr; }

std::string TableReader::one_of(const std::vector<std::string>& keys) const {
  std::string found;
  for (const std::string& key : keys) {
    if (!has(key)) continue;
    if (!found.empty())
      fail(key, fmt::format("found both '{}' and '{}', expected exactly one of {}", found, key, fmt::join(keys, ", ")));
    found = key;
  }
  if (found.empty()) fail("", fmt::format("missing key, expected exactly one of {}", fmt::join(keys, ", ")));
  return found;
}

double TableReader::number_in(const toml::node& node, const std::string& name, const Range& range) const {
  double value = 0;
  if (const auto* integer = node.as_integer())
    value = double(integer->get());
  else if (const auto* real = node.as_floating_point())
    value = real->get();
  else
    wrong(node, name, range.words());
  if (!range.contains(value)) wrong(node, name, range.words());
  return value;
}

double TableReader::number(const std::string& key, const Range& range, std::optional<double> fallback) const {
  if (fallback && !has(key)) return *fallback;
  return number_in(require(key, range.words()), key, range);
}

long long TableReader::integer_in(const toml::node& node, const std::string& name, long long least,
                                  long long greatest) const {
  const auto* value = node.as_integer();
  if (!value || value->get() < least || value->get() > greatest)
    wrong(node, name, fmt::format("an integer from {} to {}", least, greatest));
  return value->get();
}

long long TableReader::integer(const std::string& key, long long least, long long greatest,
                               std::optional<long long> fallback) const {
  if (fallback && !has(key)) return *fallback;
  return integer_in(require(key, fmt::format("an integer from {} to {}", least, greatest)), key, least, greatest);
}

std::vector<long long> TableReader::integers(const std::string& key, std::size_t length, long long least,
                                             long long greatest) const {
  const toml::array& array = list(key, "a list of integers", length);
  std::vector<long long> values;
  for (std::size_t i = 0; i < length; ++i)
    values.push_back(integer_in(array[i], fmt::format("{}[{}]", key, i), least, greatest));
  return values;
}

bool TableReader::flag(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  const toml::node& node = require(key, "true or false");
  if (const auto* value = node.as_boolean()) return value->get();
  wrong(node, key, "true or false");
}

std::string TableReader::text(const std::string& key, std::optional<std::string> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const toml::node& node = require(key, "a text in quotes");
  if (const auto* value = node.as_string()) return value->get();
  wrong(node, key, "a text in quotes");
}

std::string TableReader::checked_name(const std::string& key, std::optional<std::string> fallback, bool of_file) const {
  std::string value = text(key, std::move(fallback));
  const bool leads_away = value == "." || value == ".." || value.find('/') != std::string::npos;
  if (!value.empty() && value.size() <= 200 && printable(value) == value && !(of_file && leads_away)) return value;
  const std::string what =
      fmt::format("a name of 1 to 200 bytes in one line{}", of_file ? ", without '/' and other than '.' and '..'" : "");
  if (has(key)) expected(key, what);
  fail("", fmt::format("without a key '{}' the name is '{}', expected {}", key, printable(value, 100), what));
}

std::string TableReader::name(const std::string& key, std::optional<std::string> fallback) const {
  return checked_name(key, std::move(fallback), false);
}

std::string TableReader::file_name(const std::string& key, std::optional<std::string> fallback) const {
  return checked_name(key, std::move(fallback), true);
}

std::string TableReader::choice(const std::string& key, const std::vector<std::string>& choices,
                                std::optional<std::string> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string what = fmt::format("one of \"{}\"", fmt::join(choices, "\", \""));
  const toml::node& node = require(key, what);
  const auto* value = node.as_string();
  if (!value) wrong(node, key, what);
  if (std::find(choices.begin(), choices.end(), value->get()) == choices.end())
    wrong(node, key, fmt::format("{}{}", what, nearest_hint(value->get(), choices)));
  return value->get();
}

const toml::array& TableReader::list(const std::string& key, const std::string& what,
                                     std::optional<std::size_t> length) const {
  const toml::node& node = require(key, what);
  const toml::array* array = node.as_array();
  if (!array) wrong(node, key, what);
  if (length && array->size() != *length)
    wrong(node, key, fmt::format("{}: {} numbers, not {}", what, *length, array->size()));
  return *array;
}

Rgb TableReader::color(const std::string& key, const Range& range, std::optional<Rgb> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string what = range.words() + ", or [r, g, b] of such";
  const toml::node& node = require(key, what);
  if (node.is_number()) return Rgb::Constant(number_in(node, key, range));
  const toml::array& array = list(key, what, 3);
  Rgb rgb;
  for (int c = 0; c < 3; ++c) rgb[c] = number_in(array[c], fmt::format("{}[{}]", key, c), range);
  return rgb;
}

Vec3 TableReader::vector(const std::string& key, std::optional<Vec3> fallback) const {
  if (fallback && !has(key)) return *fallback;
  return vector_in(key, coordinate);
}

Vec3 TableReader::vector_in(const std::string& key, const Range& range) const {
  const toml::array& array = list(key, "[x, y, z]", 3);
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = number_in(array[i], fmt::format("{}[{}]", key, i), range);
  return v;
}

Vec3 TableReader::direction(const std::string& key, std::optional<Vec3> fallback) const {
  if (fallback && !has(key)) return fallback->normalized();
  const Vec3 v = vector_in(key, any_number);
  // Scaled first: the squares of very long or very short vectors leave the range of double.
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0)) expected(key, "a direction, not zero");
  return (v / largest).normalized();
}

std::vector<double> TableReader::numbers(const std::string& key, const Range& range,
                                         std::optional<std::size_t> length) const {
  const toml::array& array = list(key, "a list of numbers", length);
  std::vector<double> values(array.size());
  for (std::size_t i = 0; i < array.size(); ++i) {
    const toml::node& node = array[i];
    // Names are built for messages only: lists of voxels are long.
    const auto* real = node.as_floating_point();
    if (real && range.contains(real->get()))
      values[i] = real->get();
    else
      values[i] = number_in(node, fmt::format("{}[{}]", key, i), range);
  }
  return values;
}

std::vector<Rgb> TableReader::colors(const std::string& key, const Range& range) const {
  const std::string what = "a list of [r, g, b]";
  std::vector<Rgb> values;
  for (const toml::node& node : list(key, what, {})) {
    const std::string name = fmt::format("{}[{}]", key, values.size());
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) wrong(node, name, "[r, g, b]");
    Rgb rgb;
    for (int c = 0; c < 3; ++c) rgb[c] = number_in((*array)[c], fmt::format("{}[{}]", name, c), range);
    values.push_back(rgb);
  }
  return values;
}

std::optional<TableReader> TableReader::table(const std::string& key) const {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (const toml::table* child = node->as_table())
    return TableReader(*child, where_.empty() ? key : where_ + ": " + key);
  wrong(*node, key, "a table");
}

TableReader TableReader::required_table(const std::string& key) const {
  require(key, "a table");
  return *table(key);
}

std::vector<TableReader> TableReader::tables(const std::string& key) const {
  std::vector<TableReader> readers;
  const toml::node* node = find(key);
  if (!node) return readers;
  const std::string what = fmt::format("a list of tables, written [[{}]]", key);
  const toml::array* array = node->as_array();
  if (!array) wrong(*node, key, what);
  for (const toml::node& element : *array) {
    const std::string name = fmt::format("{} {}", key, readers.size());
    const toml::table* child = element.as_table();
    if (!child) wrong(element, name, "a table");
    readers.emplace_back(*child, where_.empty() ? name : where_ + ": " + name);
  }
  return readers;
}

}  // namespace airlight::scene::load
