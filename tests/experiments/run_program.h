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

inline Result run(const std::string& arguments, const TemporaryFolder& folder) {
  const std::string out = (folder.path() / "stdout").string(), err = (folder.path() / "stderr").string();
  const int status = std::system(
      ("cd '" + folder.path().string() + "' && '" + program + "' " + arguments + " >'" + out + "' 2>'" + err + "'")
          .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(out), read_bytes(err)};
}

}  // namespace airlight::test
