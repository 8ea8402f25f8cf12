// Is a mesh file whole? The importer takes a file that is cut short, or whose indices point nowhere, for a smaller or a
// different mesh, and any count in a header for the truth; so the structure is walked here first.
#pragma once
#include <string>

namespace airlight::scene {

// Each throws Error: path, line (text formats) or byte (binary PLY), what was found, what was expected. Checked:
// header, announced counts against what is there, three numbers per vertex, all finite in single precision, at least
// three corners per face, indices in range.
void check_off(const std::string& path, const std::string& content);
void check_ply(const std::string& path, const std::string& content);
// OBJ: the same, and returns the vertices and faces alone, in absolute indices: on damaged lines of other kinds the
// importer (5.2.4) is seen to write out of bounds.
std::string plain_obj(const std::string& path, const std::string& content);

}  // namespace airlight::scene
