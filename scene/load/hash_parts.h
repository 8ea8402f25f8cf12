// Common parts of the hashes of scenes and of flows, hashed by their values.
#pragma once
#include "scene/geometry/surface.h"
#include "scene/load/content_hash.h"
#include "scene/media/region.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene::load {

void add(ContentHash&, const VoxelGrid&);
void add(ContentHash&, const Region&);
void add(ContentHash&, const Surface&);

}  // namespace airlight::scene::load
