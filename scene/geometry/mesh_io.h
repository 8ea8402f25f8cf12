// Triangle meshes from files.
#pragma once
#include <string>

#include "scene/geometry/surface.h"

namespace airlight::scene {

// Reads an OBJ, PLY or OFF file: all its meshes as one, polygons cut into triangles, vertices as in the file, of OBJ
// those at one place as one (the scene file's transform is applied by the caller). Zero-area triangles are dropped and
// counted in removed_degenerate. Throws Error (file, what was found, what was expected) if the file is missing, empty,
// damaged, of another kind, holds no triangle, an index out of range or a vertex that is not finite.
TriangleMesh read_mesh(const std::string& path);

}  // namespace airlight::scene
