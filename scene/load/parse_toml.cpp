#include "scene/load/parse_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/load/overrides.h"

namespace airlight::scene::load {
namespace {

// The text of an override is its own place.
std::string place(const std::string& name, std::size_t line, std::size_t column) {
  return is_override(name) ? name : fmt::format("{}:{}:{}", name, line, column);
}

// Walks the text outside strings and comments, where brackets and dots nest. A text on which this walk and the parser
// disagree is no TOML, and the parser ends there.
class Nesting {
 public:
  Nesting(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  void check() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
        continue;
      }
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (c == '[' || c == '{') ++levels_;
      if (c == ']' || c == '}') levels_ = std::max(0, levels_ - 1);
      // A key has as many parts as dots and one; every other token ends it.
      if (c == '.')
        ++dots_;
      else if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos)
        dots_ = 0;
      if (levels_ > most_toml_levels)
        fail(fmt::format("found lists or tables in more than {} levels", most_toml_levels));
      if (dots_ >= most_toml_levels) fail(fmt::format("found a key of more than {} parts", most_toml_levels));
      ++at_;
    }
  }

 private:
  bool tripled(char quote, std::size_t at) const { return text_.substr(at, 3) == std::string(3, quote); }

  void skip_string(char quote) {
    const bool escapes = quote == '"', many_lines = tripled(quote, at_);
    at_ += many_lines ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      if (escapes && text_[at_] == '\\') {
        ++at_;
      } else if (!many_lines && (text_[at_] == quote || text_[at_] == '\n')) {
        at_ += text_[at_] == quote;
        return;
      } else if (many_lines && tripled(quote, at_)) {
        at_ += 3;
        for (int i = 0; i < 2 && at_ < text_.size() && text_[at_] == quote; ++i) ++at_;  // the string may end in quotes
        return;
      }
    }
    at_ = std::min(at_, text_.size());
  }

  [[noreturn]] void fail(const std::string& what) const {
    const std::string_view before = text_.substr(0, at_);
    const std::size_t line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t column = at_ - (before.rfind('\n') + 1) + 1;
    throw Error(fmt::format("{}: {}, expected fewer", place(name_, line, column), what));
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int levels_ = 0, dots_ = 0;
};

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& name) {
  if (text.size() > most_toml_bytes)
    throw Error(fmt::format("{}: found {} bytes, expected at most {}", name, text.size(), most_toml_bytes));
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
    throw Error(fmt::format("{}: found a zero byte at offset {}, expected a text file", name, zero));
  Nesting(text, name).check();
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    const auto& at = e.source().begin;
    throw Error(fmt::format("{}: {}", place(name, at.line, at.column), printable(e.description(), 300)));
  }
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04x}", int(c));
    else
      out += c;
  }
  return out + '"';
}

}  // namespace airlight::scene::load
