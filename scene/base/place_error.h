// How thick may a medium be before the rounding of places decides on its optical depths?
#pragma once
#include <string>

#include "scene/scene.h"

namespace airlight::scene {

// What the rounding of places can do to an optical depth: the greatest extinction of a medium with a boundary, times
// 2^-53 of the lengths in play, its diagonal and its distance from the camera. 0 without such a medium. What single
// precision can tell is in single_precision.h. The loader's require_resolved is about where a scene lies (coordinates
// from its origin), and takes one Gaussian at a time: beyond 1e-4 there are only overlaps of very many.
double place_error(const Scene&);

// In one line: that this is more than `most`. Empty if not.
std::string too_thick(const Scene&, double most);

}  // namespace airlight::scene
