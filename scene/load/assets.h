// Files that a scene names: looked for beside the scene file first, then in the data folder.
#pragma once
#include <string>

#include "scene/load/table_reader.h"

namespace airlight::scene::load {

// The path of the file that `key` names. Throws Error (position, the places looked at) if it is in neither.
std::string find_asset(const TableReader&, const std::string& key, const std::string& folder);

// The whole content of a text or binary file. Throws Error: missing, a folder, unreadable, empty, over max_bytes.
std::string read_whole_file(const std::string& path, std::size_t max_bytes = std::size_t(1) << 28);

}  // namespace airlight::scene::load
