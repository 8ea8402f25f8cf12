// Text to JSON: the only place that parses whole files of it.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace airlight::experiments {

// Greatest size of a JSON file: 32 MiB take 1 GB once they are parsed.
inline constexpr std::size_t most_json_bytes = std::size_t(1) << 25;

// Levels of lists and objects. Printing a value, which messages do, is recursive: 100,000 levels end the stack.
inline constexpr int most_json_levels = 32;

// Throws Error, one line, with the name: too deep, not JSON, or a key that its object has twice.
nlohmann::json parse_json(const std::string& text, const std::string& name);

// Parses a JSON file. Throws Error also if the file cannot be read or is too long.
nlohmann::json read_json(const std::string& path);

}  // namespace airlight::experiments
