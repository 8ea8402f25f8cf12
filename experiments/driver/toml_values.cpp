#include "experiments/driver/toml_values.h"

#include <fmt/format.h>

#include <sstream>

namespace airlight::experiments {
using scene::load::TableReader;
namespace {

// A value as TOML text, for overrides of a scene.
std::string quoted(const toml::node& node) {
  std::ostringstream out;
  node.visit([&](const auto& n) { out << toml::toml_formatter(n, toml::toml_formatter::default_flags); });
  return out.str();
}

// { "film.width" = 64 } and { film.width = 64 } alike.
void flatten(const toml::table& table, const std::string& prefix, Pairs& out) {
  for (const auto& [key, value] : table) {
    const std::string path = prefix + std::string(key.str());
    if (const toml::table* inner = value.as_table())
      flatten(*inner, path + ".", out);
    else
      out[path] = quoted(value);
  }
}

}  // namespace

std::string plain(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto number = node.value_exact<double>())
    return fmt::format("{}", *number);  // shortest: 0.3, not 0.29999999999999999
  return quoted(node);
}

std::vector<std::string> strings(const toml::table& table, const std::string& key, const TableReader& reader) {
  const toml::node* node = table.get(key);
  if (!node) return {};
  const toml::array* list = node->as_array();
  if (!list) reader.expected(key, "a list of strings");
  std::vector<std::string> all;
  for (const toml::node& item : *list) {
    if (!item.is_string()) reader.expected(key, "a list of strings");
    all.push_back(*item.value_exact<std::string>());
  }
  return all;
}

// settings = { name = value, ... }
Pairs settings(const toml::table& table, const std::string& key, const TableReader& reader) {
  Pairs pairs;
  if (!reader.has(key)) return pairs;
  const toml::table* inner = table.get(key)->as_table();
  if (!inner) reader.expected(key, "a table { name = value }");
  for (const auto& [name, value] : *inner) pairs[std::string(name.str())] = plain(value);
  return pairs;
}

Pairs overrides(const toml::table& table, const std::string& key, const TableReader& reader) {
  Pairs pairs;
  if (!reader.has(key)) return pairs;
  const toml::table* inner = table.get(key)->as_table();
  if (!inner) reader.expected(key, "a table { \"path.in.the.scene\" = value }");
  flatten(*inner, "", pairs);
  return pairs;
}

std::vector<Pairs> overrides_of_each(const toml::table& table, const std::string& key, std::size_t n,
                                     const TableReader& reader) {
  std::vector<Pairs> each(n);
  if (!reader.has(key)) return each;
  const toml::table* inner = table.get(key)->as_table();
  if (!inner) reader.expected(key, "a table { \"path.in.the.scene\" = [values] }");
  for (const auto& [path, list] : *inner) {
    const toml::array* values = list.as_array();
    if (!values || values->size() != n)
      reader.fail(key, fmt::format("'{}': expected a list of {} values, one for each of the sweep", path.str(), n));
    for (std::size_t i = 0; i < n; ++i) each[i][std::string(path.str())] = quoted((*values)[i]);
  }
  return each;
}

}  // namespace airlight::experiments
