#include "scene/load/assets.h"

#include <fmt/format.h>

#include <filesystem>

#include "scene/data_folder.h"
#include "scene/error.h"

namespace fs = std::filesystem;

namespace airlight::scene::load {

std::string find_asset(const TableReader& reader, const std::string& key, const std::string& folder) {
  return find_asset(reader, key, reader.text(key), folder);
}

std::string find_asset(const TableReader& reader, const std::string& key, const std::string& name,
                       const std::string& folder) {
  if (name.empty()) reader.expected(key, "the name of a file");
  std::error_code code;
  const fs::path beside = fs::path(folder) / name;  // `name` alone if it is absolute
  if (fs::exists(beside, code)) return beside.string();
  const std::string data = data_folder();
  if (data.empty() || fs::path(name).is_absolute())
    reader.expected(key, fmt::format("a file: there is no {}{}", beside.string(),
                                     fs::path(name).is_absolute() ? "" : ", and AIRLIGHT_DATA names no data folder"));
  const fs::path shared = fs::path(data) / name;
  if (fs::exists(shared, code)) return shared.string();
  reader.expected(key, fmt::format("a file: there is neither {} nor {}", beside.string(), shared.string()));
}

}  // namespace airlight::scene::load
