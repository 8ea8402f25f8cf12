#include "scene/load/values.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/base/printable.h"
#include "scene/load/overrides.h"

namespace airlight::scene::load {
namespace {

// Appends until the text is longer than `most`: the lists of a scene may have millions of numbers.
void append(std::string& text, const toml::node& node, std::size_t most) {
  if (const auto* value = node.as_integer()) {
    text += fmt::format("{}", value->get());
  } else if (const auto* value = node.as_floating_point()) {
    text += fmt::format("{}", value->get());
  } else if (const auto* value = node.as_boolean()) {
    text += value->get() ? "true" : "false";
  } else if (const auto* value = node.as_string()) {
    text += '"' + value->get().substr(0, most) + '"';
  } else if (const toml::array* array = node.as_array()) {
    text += '[';
    for (std::size_t i = 0; i < array->size() && text.size() <= most; ++i) {
      if (i > 0) text += ", ";
      append(text, (*array)[i], most);
    }
    text += ']';
  } else {
    text += node.is_table() ? "a table" : "a date or time";
  }
}

}  // namespace

std::string location(const toml::source_region& source) {
  std::string path = source.path ? *source.path : "scene";
  if (is_override(path)) return path;
  return fmt::format("{}:{}:{}", path, source.begin.line, source.begin.column);
}

std::string written(const toml::node& node) {
  constexpr std::size_t most = 60;
  std::string text;
  append(text, node, most);
  return printable(text, most);
}

bool Range::contains(double x) const {
  if (!std::isfinite(x)) return infinite && x == infinity;
  if (signs) x = std::abs(x);
  if (zero && x == 0) return true;
  return (open_least ? x > least : x >= least) && (open_greatest ? x < greatest : x <= greatest);
}

std::string Range::words() const {
  if (least == -infinity && greatest == infinity) return "a finite number";
  if (greatest == infinity) return fmt::format("a number {} {}", open_least ? ">" : ">=", least);
  if (least == -infinity) return fmt::format("a number {} {}", open_greatest ? "<" : "<=", greatest);
  return fmt::format("{}a number {}in {}{:.6g}, {:.6g}{}{}", zero ? "0 or " : "",
                     signs ? "of either sign, its size " : "", open_least ? '(' : '[', least, greatest,
                     open_greatest ? ')' : ']', infinite ? ", or inf" : "");
}

}  // namespace airlight::scene::load
