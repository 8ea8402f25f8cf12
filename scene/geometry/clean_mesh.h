// Triangles that are none, or are there twice.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::scene {

// Drops triangles of zero area (two corners alike, or the three on a line as far as the rounded edges can tell) and
// counts them in removed_degenerate. Slivers with any area stay: a watertight mesh needs them.
void remove_degenerate(TriangleMesh&);

// Indices, ascending, of the triangles without those whose corners and winding repeat an earlier one's.
std::vector<int> distinct_triangles(const TriangleMesh&);

}  // namespace airlight::scene
