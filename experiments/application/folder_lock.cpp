#include "experiments/application/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "experiments/application/interrupt.h"
#include "experiments/application/say.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

int open_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) throw Error(fmt::format("{}: {}", folder.string(), std::strerror(errno)));
  return descriptor;
}

// False where another holds the lock. A file system without locks is told, and gone on with.
bool locked(int descriptor, const std::filesystem::path& folder) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
  if (errno == EWOULDBLOCK || errno == EINTR) return false;
  say(fmt::format(
      "warning: {}: this folder cannot be locked ({}): nothing keeps a second airlight from writing into it",
      folder.string(), std::strerror(errno)));
  return true;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : descriptor_(open_folder(folder)) {
  if (locked(descriptor_, folder)) return;
  ::close(descriptor_);
  throw Error(fmt::format("{}: another airlight writes into this folder, expected one at a time or another folder",
                          folder.string()));
}

FolderLock FolderLock::wait_for(const std::filesystem::path& folder) {
  FolderLock lock;
  lock.descriptor_ = open_folder(folder);
  for (bool told = false; !locked(lock.descriptor_, folder); told = true) {
    if (!told) say(fmt::format("{}: waiting for another airlight that writes into this folder", folder.string()));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    check_interrupted();
  }
  return lock;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace airlight::experiments
