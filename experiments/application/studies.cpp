#include "experiments/application/studies.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "experiments/application/build_info.h"
#include "scene/base/error.h"

namespace airlight::experiments {

namespace {

constexpr const char* commit_before = "AIRLIGHT_COMMIT_BEFORE";

}  // namespace

void check_commit_of_studies() {
  const char* before = std::getenv(commit_before);
  if (!before || commit() == before) return;
  throw Unavailable(
      fmt::format("airlight_studies is of commit {}, airlight of {}: scripts/build builds both", commit(), before));
}

void go_on_with_studies(char** argv) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "airlight_studies";
  setenv(commit_before, commit().c_str(), 1);
  execv(program.c_str(), argv);
  throw Unavailable(fmt::format("{}: {}: this needs probes or verify, which scripts/build builds", program.string(),
                                std::strerror(errno)));
}

}  // namespace airlight::experiments
