#include "scene/load/overrides.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/printable.h"
#include "scene/base/settings.h"
#include "scene/load/parse_toml.h"
#include "scene/load/table_reader.h"

namespace airlight::scene::load {
namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::string join(const std::vector<std::string>& parts, std::size_t count) {
  return fmt::format("{}", fmt::join(parts.begin(), parts.begin() + count, "."));
}

// One override on its way down the tree.
struct Walk {
  std::string label;  // "override PATH = TEXT of FILE"
  std::vector<std::string> parts;

  [[noreturn]] void fail(const std::string& message) const { throw Error(label + ": " + message); }

  // The container that part `i` stands in, in words.
  std::string container(std::size_t i) const { return i == 0 ? "the file" : fmt::format("'{}'", join(parts, i)); }

  std::size_t index(const toml::array& array, std::size_t i) const {
    const std::string& part = parts[i];
    std::size_t value = 0;
    const auto [stop, code] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (code != std::errc() || stop != part.data() + part.size() || value >= array.size())
      fail(fmt::format("{} is a list of {}, found '{}', expected an index below {}", container(i), array.size(), part,
                       array.size()));
    return value;
  }

  toml::node& step(toml::node& node, std::size_t i) const {
    if (toml::array* array = node.as_array()) return *array->get(index(*array, i));
    toml::table* table = node.as_table();
    if (!table) fail(fmt::format("{} is {}, expected a table or a list", container(i), written(node)));
    if (toml::node* child = table->get(parts[i])) return *child;
    std::vector<std::string> keys;
    for (const auto& [key, value] : *table) keys.emplace_back(key.str());
    fail(fmt::format("there is no '{}'; {} has {}{}", join(parts, i + 1), container(i), fmt::join(keys, ", "),
                     nearest_hint(parts[i], keys)));
  }
};

// The value that a text stands for, alone in a table under the key "value".
toml::table parse_value(const Walk& walk, const std::string& text) {
  toml::table table;
  try {
    table = parse_toml("value = " + text, walk.label);
  } catch (const Error& e) {
    throw Error(fmt::format("{}; expected a TOML value, texts in quotes", e.what()));
  }
  if (table.size() != 1 || !table.contains("value")) walk.fail("expected one TOML value");
  return table;
}

void assign(toml::node& container, const Walk& walk, toml::node&& value) {
  const std::size_t last = walk.parts.size() - 1;
  std::move(value).visit([&](auto&& concrete) {
    using Value = std::remove_cvref_t<decltype(concrete)>;
    if (toml::array* array = container.as_array())
      array->replace(array->cbegin() + walk.index(*array, last), Value(std::forward<decltype(concrete)>(concrete)));
    else if (toml::table* table = container.as_table())
      table->insert_or_assign(walk.parts[last], Value(std::forward<decltype(concrete)>(concrete)));
    else
      walk.fail(fmt::format("{} is {}, expected a table or a list", walk.container(last), written(container)));
  });
}

// Assigns below every child of a list where a part is `*`.
void descend(toml::node& node, const Walk& walk, std::size_t i, const std::string& text) {
  if (walk.parts[i] == "*") {
    const toml::array* array = node.as_array();
    if (!array) walk.fail(fmt::format("{} is {}, expected a list for '*'", walk.container(i), written(node)));
    for (std::size_t k = 0; k < array->size(); ++k) {
      Walk one = walk;
      one.parts[i] = std::to_string(k);
      descend(node, one, i, text);
    }
  } else if (i + 1 == walk.parts.size()) {
    assign(node, walk, std::move(*parse_value(walk, text).get("value")));
  } else {
    descend(walk.step(node, i), walk, i + 1, text);
  }
}

}  // namespace

bool is_override(const std::string& source_path) { return source_path.rfind("override ", 0) == 0; }

void apply_overrides(toml::table& root, const std::map<std::string, std::string>& overrides, const std::string& file,
                     const std::vector<std::string>& implied) {
  for (const auto& [path, text] : overrides) {
    const Walk walk{fmt::format("override {} = {} of {}", printable(path, 100), printable(text, 60), file),
                    split(path)};
    if (std::find(walk.parts.begin(), walk.parts.end(), "") != walk.parts.end())
      walk.fail("found an empty part in the path, expected names and indices joined by dots");
    parse_value(walk, text);  // a mistake there is told before one in the path
    if (walk.parts.size() > 1 && std::find(implied.begin(), implied.end(), walk.parts[0]) != implied.end())
      root.emplace<toml::table>(walk.parts[0]);  // nothing happens if it is there
    descend(root, walk, 0, text);
  }
}

}  // namespace airlight::scene::load
