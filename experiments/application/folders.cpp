#include "experiments/application/folders.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "experiments/application/say.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

bool is_root(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "experiments" / "README.md", ignored);
}

// The folder, or one above it, that is the root of a project, or whose share/airlight is one (cmake --install); empty if there is none.
fs::path root_above(fs::path folder) {
  while (!is_root(folder)) {
    if (fs::path installed = folder / "share/airlight"; is_root(installed)) return installed;
    if (folder.empty() || folder == folder.root_path()) return {};
    folder = folder.parent_path();
  }
  return folder;
}

}  // namespace

Folders::Folders(fs::path project, fs::path results_folder, fs::path cache_folder)
    : root(std::move(project)), results(std::move(results_folder)), cache(std::move(cache_folder)) {
  if (results.empty()) results = root / "results";
  if (cache.empty()) cache = root / "results" / "cache";
  rows = (default_results() ? cache : results) / "rows";
}

bool Folders::default_results() const {
  return fs::weakly_canonical(results) == fs::weakly_canonical(root / "results");
}

fs::path project_root(const std::string& given) {
  if (!given.empty()) {
    if (!is_root(given)) throw Error(fmt::format("{}: there is no experiments/README.md in this folder", given));
    return given;
  }
  std::error_code ignored;
  if (fs::path root = root_above(fs::current_path(ignored)); !root.empty()) return root;
  fs::path root = root_above(fs::read_symlink("/proc/self/exe", ignored).parent_path());
  if (root.empty())
    throw Error("no folder above the current one holds experiments/README.md; name the project's folder with --root");
  say(fmt::format("no project above the current folder (experiments/README.md): using {}, above the program",
                  root.string()));
  return root;
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    throw scene::CannotWrite(fmt::format("{}: cannot make this folder: {}", folder.string(), failure.message()));
}

void check_writable(const fs::path& folder, const std::string& remedy) {
  std::error_code ignored;
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there, ignored) && there.has_relative_path()) there = there.parent_path();
  const int reason = !fs::is_directory(there, ignored) ? ENOTDIR : access(there.c_str(), W_OK | X_OK) != 0 ? errno : 0;
  if (reason != 0)
    throw scene::CannotWrite(fmt::format("{}: cannot write into {}: {}; {}", folder.string(), there.string(),
                                         std::strerror(reason), remedy));
}

}  // namespace airlight::experiments
