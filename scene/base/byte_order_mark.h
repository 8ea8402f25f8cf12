// The byte order mark of UTF-8: three invisible bytes that some editors put before a text.
#pragma once
#include <string_view>

namespace airlight::scene {

inline std::string_view without_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

}  // namespace airlight::scene
