// Which silhouette edges the rays of a tile of pixels may cross.
#pragma once
#include <vector>

#include "methods/shadow_planes/shadow_volumes.h"
#include "scene/renderer.h"

namespace airlight::shadow_planes {

inline constexpr int tile_side = 16;  // pixels

// A vertex lies on the side of the plane through ray and light that a function says which is linear over the film.
// So an edge whose ends are on one side at the four corners of a tile is crossed by none of its rays. Conservative and
// exact: no clipping of infinite planes.
void edges_of_tile(const ShadowVolumes&, const scene::View&, int tile_x, int tile_y, std::vector<int>& edges);

}  // namespace airlight::shadow_planes
