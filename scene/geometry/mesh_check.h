// Is a mesh file whole? The importer takes a file that is cut short, or whose indices point nowhere, for a smaller or a
// different mesh, and any count in a header for the truth; so the structure is walked here first.
#pragma once
#include <string>

namespace airlight::scene {

// Each throws Error: path, line (text formats) or byte (binary PLY), what was found, what was expected. Checked:
// header, announced counts against what is there, three numbers per vertex, all finite in single precision, three to
// plain_mesh.h's most_corners per face, indices in range.
//
// Returned are the vertices and faces alone: of OBJ as text, in absolute indices; of the others as binary PLY. Of the
// rest the importer (5.2.5) makes what it likes: it writes out of bounds on damaged lines of OBJ, on lines of 4096
// bytes of OFF, on elements that a PLY has twice; aborts on PLY elements that it takes for faces; and leaves out OFF
// faces of ten corners.
std::string plain_off(const std::string& path, const std::string& content);
std::string plain_obj(const std::string& path, const std::string& content);
std::string plain_ply(const std::string& path, const std::string& content);

}  // namespace airlight::scene
