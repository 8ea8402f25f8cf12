#include "scene/base/content_key.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace airlight {

std::string content_key(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string content_key(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all += fmt::format("{}:{}\n", part.size(), part);
  return content_key(std::string_view(all));
}

}  // namespace airlight
