// The teapot that Martin Newell designed at the University of Utah in 1975: 32 bicubic Bezier patches.
#pragma once
#include "scene/geometry/surface.h"

namespace airlight::scene {

// Upright on the plane y = 0 around the y axis, 3.15 m high, the spout along +x, as in the published control points
// (which have z up and are 3.15 units high). `size` >= 2 vertices on each side of a patch: 32 size^2 in all. Its
// surface is open: the lid does not touch the rim, and handle and spout begin inside the body. Throws Error for another
// size.
TriangleMesh make_teapot(int size);

}  // namespace airlight::scene
