// Half a second of warm smoke that rises from a ball, ten frames of it, and what a simulation of it leaves.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "scene/base/read_file.h"
#include "tests/experiments/run_program.h"

namespace airlight::test {

inline const std::string rising_smoke = R"(
[flow]
duration = 0.5
frame_rate = 20
box = { lo = [0, 0, 0], hi = [1, 2, 1] }
[sides]
top = { type = "open" }
[fluid]
gravity = [0, -9.81, 0]
expansion = 0.0033
[[source]]
region = { type = "sphere", center = [0.5, 0.3, 0.5], radius = 0.25 }
density = 1
temperature = 100
)";

// The program's command line for it, but for the folder.
inline const std::string simulate_smoke = "'" + program + "' simulate smoke.toml --set n=24 --out ";

// Bytes by name.
inline std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    all[entry.path().filename().string()] = scene::read_whole_file(entry.path().string(), 1 << 28);
  return all;
}

}  // namespace airlight::test
