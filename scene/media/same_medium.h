// Is a medium of the next frame the medium of this one?
#pragma once
#include "scene/media/medium.h"

namespace airlight::scene {

// All values are equal, bit by bit, the name left out; fields that scenes share (grids, maps, ...) are one and the same object.
bool same_medium(const Medium&, const Medium&);
bool same_media(const std::vector<Medium>&, const std::vector<Medium>&);

}  // namespace airlight::scene
