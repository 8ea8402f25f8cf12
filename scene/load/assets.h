// Files that a scene names: looked for beside the scene file first, then in the data folder.
#pragma once
#include <string>

#include "scene/base/read_file.h"
#include "scene/load/table_reader.h"

namespace airlight::scene::load {

// The path of the file that `key` names. Throws Error (position, the places looked at) if it is in neither.
std::string find_asset(const TableReader&, const std::string& key, const std::string& folder);
// The path of the file `name`, which the key `key` gave.
std::string find_asset(const TableReader&, const std::string& key, const std::string& name, const std::string& folder);

// The name that `key` gives for the table's `frame` where it is that of a sequence: # stand for its digits, leading zeros included. Throws
// Error.
std::string name_of_frame(const TableReader&, const std::string& key = "file");

}  // namespace airlight::scene::load
