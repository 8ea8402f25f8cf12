#include "scene/read_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "scene/error.h"

namespace fs = std::filesystem;

namespace airlight::scene {

std::string read_whole_file(const std::string& path, std::size_t max_bytes) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) throw Error(fmt::format("{}: no such file", path));
  if (fs::is_directory(status)) throw Error(fmt::format("{}: found a folder, expected a file", path));
  // A pipe nobody writes to would be waited for, and a device may never end.
  if (!fs::is_regular_file(status)) throw Error(fmt::format("{}: found a pipe or a device, expected a file", path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(fmt::format("{}: cannot be opened for reading", path));
  // Read in pieces and not by the reported size, which files of /proc do not have.
  std::string content;
  std::string piece(std::size_t(1) << 16, '\0');
  while (stream.read(piece.data(), std::streamsize(piece.size())), stream.gcount() > 0) {
    content.append(piece, 0, std::size_t(stream.gcount()));
    if (content.size() > max_bytes)
      throw Error(fmt::format("{}: found more than {} bytes, expected fewer", path, max_bytes));
  }
  if (stream.bad()) throw Error(fmt::format("{}: cannot be read to its end", path));
  if (content.empty()) throw Error(fmt::format("{}: found an empty file", path));
  return content;
}

}  // namespace airlight::scene
