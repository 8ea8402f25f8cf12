// OpenEXR files with layers of 16-bit floats, for films that must be small.
#pragma once
#include <set>
#include <string>

#include "scene/film/film.h"

namespace airlight::scene {

// A variant of write_exr (film.h) that stores the layers in `halves` as 16-bit floats. Throws Error where a 16-bit
// float does not hold a value exactly.
void write_exr_with_halves(const std::string& path, const Film&, const std::set<std::string>& halves);

}  // namespace airlight::scene
