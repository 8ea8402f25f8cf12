// Residuals as files: a version line, the layout of the grid, the bricks that hold anything, a checksum (residual_file.cpp has the table).
#pragma once
#include <string>

#include "scene/convert/residual.h"

namespace airlight::scene {

// Throws Error for a residual that cannot be read back (a size beyond what read_residual takes).
std::string residual_bytes(const Residual&);
// Throws Error in one line: not a residual, another version, shorter or longer than its own header says, damaged, or numbers that no
// residual has. Every length is checked before anything is made of it.
Residual residual_from_bytes(const std::string& bytes);

// Read and write a residual as a file (atomically). The text of an Error begins with the path.
Residual read_residual(const std::string& path);
void write_residual(const std::string& path, const Residual&);

}  // namespace airlight::scene
