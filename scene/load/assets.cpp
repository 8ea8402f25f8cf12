#include "scene/load/assets.h"

#include <fmt/format.h>

#include <filesystem>

#include "scene/base/data_folder.h"
#include "scene/base/error.h"

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

std::string name_of_frame(const TableReader& reader, const std::string& key) {
  std::string name = reader.text(key);
  // Within the folders' names a # counts only where there is none behind them and a frame is asked for.
  const std::size_t own = name.rfind('/') == std::string::npos ? 0 : name.rfind('/') + 1;
  std::size_t first = name.find('#', own);
  if (first == std::string::npos && reader.has("frame")) first = name.find('#');
  if (first == std::string::npos) {
    if (reader.has("frame")) reader.fail("frame", "frame has no effect: there is no # in the name of the file");
    return name;
  }
  const std::size_t digits = std::min(name.find_first_not_of('#', first), name.size()) - first;
  if (name.find('#', first + digits) != std::string::npos)
    reader.expected(key, "the digits of the frame in one place, as in smoke_####.vdb");
  if (!reader.has("frame")) reader.fail(key, fmt::format("{} = \"{}\" is a sequence, expected a frame", key, name));
  const std::string frame = fmt::format("{:0{}}", reader.integer("frame", 0, 999'999'999, 0), digits);
  return name.replace(first, digits, frame);
}

}  // namespace airlight::scene::load
