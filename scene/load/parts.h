// The parts of a scene file, each read from its table. scene/README.md is the user's description of all of them.
#pragma once
#include <string>

#include "scene/load/table_reader.h"
#include "scene/scene.h"

namespace airlight::scene::load {

Camera read_camera(TableReader);
Light read_light(TableReader, const std::string& folder);
Medium read_medium(TableReader, const std::string& folder);

// A field of each kind; the reader is the medium's. They allow their own keys beside those of every medium.
GaussianSum read_gaussian_sum(TableReader&, const std::string& folder);

// Keys that every medium has, whatever its type.
inline const std::vector<std::string> medium_keys = {"name", "type", "sigma_t", "albedo", "phase", "region"};
// The same and those of one type.
std::vector<std::string> medium_keys_and(const std::vector<std::string>& keys);

}  // namespace airlight::scene::load
