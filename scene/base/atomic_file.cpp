#include "scene/base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "scene/base/error.h"

namespace airlight::scene {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  throw CannotWrite(fmt::format("{}: cannot write: {}", path, std::strerror(error)));
}

// Returns 0 or an errno.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes.remove_prefix(std::size_t(n));
  }
  return 0;
}

std::string folder_of(const std::string& target) {
  const std::string folder = std::filesystem::path(target).parent_path().string();
  return folder.empty() ? "." : folder;
}

// A name beside `target` that no other process or call picks.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return fmt::format("{}.{}-{}.tmp", target, ::getpid(), counter++);
}

// Opens a new file beside `target`; a name left behind by a killed process is stepped over.
int open_temporary(const std::string& target, std::string& name) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    name = temporary_name(target);
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

// Writes everything and flushes it to the disk. Returns 0 or an errno.
int fill(int descriptor, std::string_view bytes) {
  const int error = write_all(descriptor, bytes);
  // EINVAL: a file system that has nothing to flush.
  if (error == 0 && ::fsync(descriptor) != 0 && errno != EINVAL) return errno;
  return error;
}

// The file has no name before it is whole, so a process killed on the way leaves nothing behind. False where the system
// has no such files; nothing was changed then.
bool write_unnamed(const std::string& target, std::string_view bytes, int& error) {
  const int descriptor = ::open(folder_of(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  error = fill(descriptor, bytes);
  bool named = true;
  if (error == 0) {
    const std::string self = fmt::format("/proc/self/fd/{}", descriptor);
    const auto link_to = [&](const std::string& name) {
      return ::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    };
    if (!link_to(target)) {
      // There is an old file: only a rename replaces it.
      const std::string temporary = temporary_name(target);
      named = errno == EEXIST && link_to(temporary);
      if (named && ::rename(temporary.c_str(), target.c_str()) != 0) {
        error = errno;
        ::unlink(temporary.c_str());
      }
    }
  }
  ::close(descriptor);
  return named;
}

int write_named(const std::string& target, std::string_view bytes) {
  std::string temporary;
  const int descriptor = open_temporary(target, temporary);
  if (descriptor < 0) return errno;
  int error = fill(descriptor, bytes);
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) ::unlink(temporary.c_str());
  return error;
}

// A pipe that nobody reads would be waited for without an end: its reader gets a second to come.
int open_pipe_or_device(const std::string& path, int flags) {
  int descriptor;
  for (int attempt = 0; (descriptor = ::open(path.c_str(), flags | O_NONBLOCK)) < 0 && errno == ENXIO; ++attempt) {
    if (attempt == 50) throw CannotWrite(fmt::format("{}: cannot write: found a pipe that nobody reads from", path));
    ::usleep(20'000);
  }
  if (descriptor < 0) fail(path, errno);
  ::fcntl(descriptor, F_SETFL, 0);  // from here on a slow reader is waited for
  return descriptor;
}

// Into a pipe or a device; `follow`: also through a link.
void write_directly(const std::string& path, std::string_view bytes, bool follow) {
  const int descriptor = open_pipe_or_device(path, O_WRONLY | O_CLOEXEC | (follow ? 0 : O_NOFOLLOW));
  int error = write_all(descriptor, bytes);
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) fail(path, error);
}

// /dev/stdout and its like: links that the system made, in folders that only the system writes.
bool is_link_of_the_system(const std::string& path) {
  std::error_code failure;
  const std::string folder = std::filesystem::canonical(folder_of(path), failure).string();
  return !failure && (folder == "/dev" || folder == "/dev/fd" || folder.starts_with("/proc/"));
}

// The rename is on the disk once the folder is. A file system that cannot do this has still done the rename.
void flush_folder(const std::string& target) {
  const int descriptor = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
  if (path.empty()) throw Error("cannot write: the file name is empty");
  struct stat status;
  if (::lstat(path.c_str(), &status) == 0) {
    const bool through_link = S_ISLNK(status.st_mode) && is_link_of_the_system(path);
    if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
    if (through_link || (!S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode)))
      return write_directly(path, bytes, through_link);
  }

  int error = 0;
  if (!write_unnamed(path, bytes, error)) error = write_named(path, bytes);
  if (error != 0) fail(path, error);
  flush_folder(path);
}

void make_private_folder(const std::filesystem::path& root, const std::filesystem::path& below) {
  std::error_code failure;
  std::filesystem::path folder = std::filesystem::absolute(root);
  if (!folder.has_filename()) folder = folder.parent_path();
  std::filesystem::create_directories(folder.parent_path(), failure);
  const auto make = [&] {
    if (!failure && ::mkdir(folder.c_str(), 0700) != 0 && !std::filesystem::is_directory(folder))
      failure.assign(errno == EEXIST ? ENOTDIR : errno, std::generic_category());
  };
  make();
  for (const auto& part : below) {
    folder /= part;
    make();
  }
  if (failure) throw CannotWrite(fmt::format("{}: cannot make this folder: {}", folder.string(), failure.message()));
}

}  // namespace airlight::scene
