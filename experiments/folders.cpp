#include "experiments/folders.h"

#include <fmt/format.h>

#include <system_error>

#include "scene/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

bool is_root(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "experiments" / "README.md", ignored);
}

}  // namespace

fs::path project_root(const std::string& given) {
  if (!given.empty()) {
    if (!is_root(given)) throw Error(fmt::format("{}: there is no experiments/README.md in this folder", given));
    return given;
  }
  std::error_code ignored;
  for (const fs::path& start : {fs::current_path(ignored), fs::read_symlink("/proc/self/exe", ignored).parent_path()})
    for (fs::path folder = start; !folder.empty(); folder = folder.parent_path()) {
      if (is_root(folder)) return folder;
      if (folder == folder.root_path()) break;
    }
  throw Error("no folder above the current one holds experiments/README.md; name the project's folder with --root");
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(fmt::format("{}: cannot make this folder: {}", folder.string(), failure.message()));
}

}  // namespace airlight::experiments
