// Files that are there whole or not at all.
#pragma once
#include <string>
#include <string_view>

namespace airlight::scene {

// Writes `bytes` to a file without a name (where the system has none: to a temporary name beside `path`), flushes them
// to the disk and gives it its name. Whatever fails (no such folder, read-only, disk full), the old file stays as it
// was, no temporary is left, and the Error is one line with the path and the system's reason. A symbolic link is
// followed. Something that is not a regular file (a pipe, a device) is written to directly.
void write_file_atomically(const std::string& path, std::string_view bytes);

}  // namespace airlight::scene
