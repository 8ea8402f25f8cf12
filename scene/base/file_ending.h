// The kind of a file, by the end of its name.
#pragma once
#include <cctype>
#include <filesystem>
#include <string>

namespace airlight::scene {

// The last dot and what follows it, in small letters (".exr" of "A.EXR"); empty if there is no dot.
inline std::string file_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace airlight::scene
