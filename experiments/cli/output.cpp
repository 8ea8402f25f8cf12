#include "experiments/cli/output.h"

#include <fmt/format.h>

#include <filesystem>

#include "scene/base/error.h"
#include "scene/base/file_ending.h"

namespace airlight::experiments::cli {

void require_output(const std::string& file, const std::string& ending) {
  if (scene::file_ending(file) != ending) throw Error(fmt::format("{}: expected a name in {}", file, ending));
  const auto folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw Error(fmt::format("{}: there is no folder {}", file, folder.string()));
}

}  // namespace airlight::experiments::cli
