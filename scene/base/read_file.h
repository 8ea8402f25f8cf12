// The bytes of an input file.
#pragma once
#include <string>

namespace airlight::scene {

// The whole content of a text or binary file. Throws Error: missing, a folder, a pipe or a device, unreadable, empty,
// over max_bytes.
std::string read_whole_file(const std::string& path, std::size_t max_bytes = std::size_t(1) << 28);

}  // namespace airlight::scene
