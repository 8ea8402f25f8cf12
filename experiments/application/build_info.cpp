#include "experiments/application/build_info.h"

#include "airlight_build_info.h"

namespace airlight::experiments {

std::string version() { return AIRLIGHT_VERSION; }
std::string commit() { return AIRLIGHT_COMMIT; }
std::string reference_id() { return AIRLIGHT_REFERENCE_ID; }
std::string source_id() { return AIRLIGHT_SOURCE_ID; }
std::string compiler() { return AIRLIGHT_COMPILER; }

std::vector<std::pair<std::string, std::string>> libraries() {
  std::vector<std::pair<std::string, std::string>> found;
  const std::string all = AIRLIGHT_LIBRARIES;  // "name version|name version|..."
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('|', begin), all.size());
    const std::size_t space = all.find(' ', begin);
    found.emplace_back(all.substr(begin, space - begin), all.substr(space + 1, end - space - 1));
    begin = end + 1;
  }
  return found;
}

}  // namespace airlight::experiments
