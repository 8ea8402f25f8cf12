#include "scene/base/content_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <limits>

#include "scene/base/content_key.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"

namespace airlight::scene {
namespace fs = std::filesystem;
namespace {

std::string bytes_of(const fs::path& path) {
  return read_whole_file(path.string(), std::numeric_limits<std::size_t>::max() / 2);
}

fs::path checksum_of(fs::path file) { return file += ".xxh128"; }

// A line in the format of xxh128sum. It contains the name of the entry, so that no other entry passes under this name.
std::string checksum_line(std::string_view bytes, const std::string& name) {
  return fmt::format("{}  {}\n", content_key(bytes), name);
}

}  // namespace

std::optional<fs::path> ContentStore::find(const std::string& name) const {
  const fs::path file = folder_ / name;
  std::error_code ignored;
  if (!fs::exists(file, ignored) || !fs::exists(checksum_of(file), ignored)) return std::nullopt;
  std::string reason;
  try {
    const std::string found = checksum_line(bytes_of(file), name), noted = bytes_of(checksum_of(file));
    if (found == noted) return file;
    const std::size_t sum = found.find(' ');
    reason = fmt::format(
        "{}: {}", file.string(),
        found.compare(0, sum, noted, 0, sum) == 0 ? "its checksum names another entry" : "checksum differs");
  } catch (const Error& error) {  // a folder, a pipe, no permission
    reason = error.what();
  }
  say(fmt::format("{}, computing it anew", reason));
  return std::nullopt;
}

void ContentStore::keep(const std::string& name, const std::function<void(const fs::path&)>& write) const {
  const fs::path file = folder_ / name;
  std::error_code failure;
  make_private_folder(folder_, fs::path(name).parent_path());
  const fs::path part =
      file.parent_path() / fmt::format("{}.{}.part{}", file.stem().string(), getpid(), file.extension().string());
  try {
    write(part);
    // A file between two checksums counts as damaged.
    const std::string checksum = checksum_line(bytes_of(part), name);
    fs::rename(part, file);
    write_file_atomically(checksum_of(file).string(), checksum);
  } catch (const fs::filesystem_error& error) {
    fs::remove(part, failure);
    throw CannotWrite(fmt::format("{}: {}", file.string(), error.code().message()));
  } catch (...) {
    fs::remove(part, failure);
    throw;
  }
}

}  // namespace airlight::scene
