#include "scene/content_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <limits>

#include "scene/atomic_file.h"
#include "scene/content_key.h"
#include "scene/error.h"
#include "scene/read_file.h"

namespace airlight::scene {
namespace fs = std::filesystem;
namespace {

std::string bytes_of(const fs::path& path) {
  return read_whole_file(path.string(), std::numeric_limits<std::size_t>::max() / 2);
}

fs::path checksum_of(fs::path file) { return file += ".xxh128"; }

}  // namespace

std::optional<fs::path> ContentStore::find(const std::string& name) const {
  const fs::path file = folder_ / name;
  std::error_code ignored;
  if (!fs::exists(file, ignored) || !fs::exists(checksum_of(file), ignored)) return std::nullopt;
  std::string reason;
  try {
    if (content_key(std::string_view(bytes_of(file))) == bytes_of(checksum_of(file))) return file;
    reason = fmt::format("{}: checksum differs", file.string());
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
    const std::string checksum = content_key(std::string_view(bytes_of(part)));
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
