// One process at a time in a folder: two would mix their files.
#pragma once
#include <filesystem>
#include <string>

namespace airlight::experiments {

// Locks the folder itself, so no file of the lock is left. The kernel ends the lock with the process, however that ends.
class FolderLock {
 public:
  // Throws Error where another process (or object) holds it: "FOLDER: another airlight writes into this folder, ...".
  explicit FolderLock(const std::filesystem::path& folder);
  // Waits until nobody else holds it, and says so. Throws Interrupted.
  static FolderLock wait_for(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  FolderLock() = default;
  int descriptor_ = -1;
};

}  // namespace airlight::experiments
