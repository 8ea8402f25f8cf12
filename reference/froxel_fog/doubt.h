// Where slices are too coarse for the media and lights of a view: said with the picture.
#pragma once
#include <string>

#include "reference/froxel_fog/options.h"
#include "scene/renderer.h"

namespace airlight::froxel_fog {

// One line, or empty. `range`: that of the slices, not empty.
std::string doubt_of(const lit_media::LitMedia&, const Options&, Interval range, const scene::Scene&,
                     const scene::View&);

}  // namespace airlight::froxel_fog
