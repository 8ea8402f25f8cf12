// Files that are there whole or not at all.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "scene/base/error.h"

namespace airlight::scene {

// A file or folder cannot be written: no permission, a read-only file system, a full disk. Exit code 2.
class CannotWrite : public Error {
 public:
  explicit CannotWrite(const std::string& line) : Error(line) {}
};

// Writes `bytes` to a file without a name (where the system has none: to a temporary name beside `path`), flushes them
// to the disk and gives it its name. Whatever fails (no such folder, read-only, disk full), the old file stays as it
// was, no temporary is left, and CannotWrite is one line with the path and the system's reason. A symbolic link is
// replaced and what it leads to stays as it is: whoever may write into a folder could otherwise have any file replaced.
// Something that is not a regular file (a pipe, a device, /dev/stdout) is written to directly; a pipe
// must have a reader within a second.
void write_file_atomically(const std::string& path, std::string_view bytes);

// Makes the folder `root` and folders below it where they are not there yet, for the user alone (mode 0700); what is
// above `root` gets the usual permissions. Throws CannotWrite.
void make_private_folder(const std::filesystem::path& root, const std::filesystem::path& below = {});

}  // namespace airlight::scene
