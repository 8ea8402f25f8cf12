// 128-bit keys of content, as 32 hex digits: for caches, journals and checksums.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace airlight {

std::string content_key(std::string_view bytes);

// Key of several parts. The borders between parts count.
std::string content_key(const std::vector<std::string>& parts);

}  // namespace airlight
