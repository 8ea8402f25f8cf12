// The program as users call it.
#pragma once
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/temporary_folder.h"

namespace airlight::test {

// The program runs in a folder of its own, so everything is named from the root of the file system.
inline const std::string root = std::filesystem::absolute(AIRLIGHT_SOURCE_DIR).string();
inline const std::string program = std::filesystem::absolute(AIRLIGHT_PROGRAM).string();
inline const std::string scenes = root + "/experiments/scenes/";

struct Result {
  int code;
  std::string out, err;
  int error_lines() const { return int(std::count(err.begin(), err.end(), '\n')); }
};

// A line for the shell, in that folder.
inline Result run_command(const std::string& command, const TemporaryFolder& folder) {
  const std::string out = folder.file("stdout"), err = folder.file("stderr");
  const int status =
      std::system(("cd '" + folder.path().string() + "' && " + command + " >'" + out + "' 2>'" + err + "'").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(out), read_bytes(err)};
}

inline Result run(const std::string& arguments, const TemporaryFolder& folder) {
  return run_command("'" + program + "' " + arguments, folder);
}

}  // namespace airlight::test
