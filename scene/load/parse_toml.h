// Text to TOML: the only place that calls the parser.
#pragma once
#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace airlight::scene::load {

// Greatest size of a TOML file: 16 MiB take 0.9 GB once they are parsed.
inline constexpr std::size_t most_toml_bytes = std::size_t(1) << 24;

// Levels of brackets, and parts of a dotted key. Tables in tables are freed, printed and walked by recursion, which
// 100,000 of them do not survive, and the parser itself counts brackets only.
inline constexpr int most_toml_levels = 32;

// Throws Error, one line: "name:line:column: what", before anything is parsed where the text is too long or too deep.
toml::table parse_toml(const std::string& text, const std::string& name);

// Text as a string of TOML, in quotes: what the parser reads back is the text, if it is UTF-8.
std::string toml_string(std::string_view text);

}  // namespace airlight::scene::load
