#include "experiments/application/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "experiments/application/json_value.h"
#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"

template class nlohmann::basic_json<>;

namespace airlight::experiments {
namespace {

std::string position(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  return fmt::format("{}:{}", std::count(before.begin(), before.end(), '\n') + 1, at - (before.rfind('\n') + 1) + 1);
}

void check_levels(const std::string& text, const std::string& name) {
  int levels = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\')
      ++i;
    else if (c == '"')
      in_string = !in_string;
    else if (!in_string && (c == ']' || c == '}'))
      --levels;
    else if (!in_string && (c == '[' || c == '{') && ++levels > most_json_levels)
      throw Error(fmt::format("{}:{}: found lists or objects in more than {} levels, expected fewer", name,
                              position(text, i), most_json_levels));
  }
}

}  // namespace

nlohmann::json parse_json(const std::string& text, const std::string& name) {
  check_levels(text, name);
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  const auto watch = [&](int, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
    if (event == nlohmann::json::parse_event_t::object_start) keys.emplace_back();
    if (event == nlohmann::json::parse_event_t::object_end) keys.pop_back();
    if (event != nlohmann::json::parse_event_t::key) return true;
    const std::string key = parsed.get<std::string>();
    if (!keys.back().insert(key).second)
      throw Error(
          fmt::format("{}: key '{}' is there twice in an object, expected once", name, scene::printable(key, 100)));
    return true;
  };
  try {
    return nlohmann::json::parse(text, watch);
  } catch (const nlohmann::json::exception& e) {
    // "[json.exception.parse_error.101] parse error at line 1, column 5: ...": the number is nobody's business.
    std::string what = e.what();
    if (const std::size_t end = what.find("] "); end != what.npos) what = what.substr(end + 2);
    throw Error(fmt::format("{}: not JSON: {}", name, scene::printable(what, 300)));
  }
}

nlohmann::json read_json(const std::string& path) {
  return parse_json(scene::read_whole_file(path, most_json_bytes), path);
}

}  // namespace airlight::experiments
