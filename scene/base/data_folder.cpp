#include "scene/base/data_folder.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "scene/base/error.h"

namespace airlight::scene {
namespace {

std::string& chosen_folder() {
  static std::string folder;
  return folder;
}

}  // namespace

std::string data_folder() {
  if (!chosen_folder().empty()) return chosen_folder();
  const char* variable = std::getenv("AIRLIGHT_DATA");
  return variable ? variable : "";
}

void set_data_folder(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_directory(path, code))
    throw Error(fmt::format("{}: expected a data folder, found none", path));
  chosen_folder() = path;
}

}  // namespace airlight::scene
