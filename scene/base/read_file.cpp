#include "scene/base/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "scene/base/error.h"

namespace fs = std::filesystem;

namespace airlight::scene {

std::string read_whole_file(const std::string& path, std::size_t max_bytes) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) throw Error(fmt::format("{}: no such file", path));
  if (fs::is_directory(status)) throw Error(fmt::format("{}: found a folder, expected a file", path));
  // A pipe nobody writes to would be waited for, and a device may never end.
  if (!fs::is_regular_file(status)) throw Error(fmt::format("{}: found a pipe or a device, expected a file", path));
  // Some files of /proc count as regular and would be waited for.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw Error(fmt::format("{}: cannot be opened for reading: {}", path, std::strerror(errno)));
  // Read in pieces and not by the reported size, which files of /proc do not have.
  std::string content;
  std::string piece(std::size_t(1) << 16, '\0');
  ssize_t count = 0;
  while (content.size() <= max_bytes && (count = ::read(descriptor, piece.data(), piece.size())) != 0) {
    if (count > 0) content.append(piece, 0, std::size_t(count));
    if (count < 0 && errno != EINTR) break;
  }
  const int failure = count < 0 ? errno : 0;
  ::close(descriptor);
  if (content.size() > max_bytes)
    throw Error(fmt::format("{}: found more than {} bytes, expected fewer", path, max_bytes));
  if (failure != 0) throw Error(fmt::format("{}: cannot be read to its end: {}", path, std::strerror(failure)));
  if (content.empty()) throw Error(fmt::format("{}: found an empty file", path));
  return content;
}

}  // namespace airlight::scene
