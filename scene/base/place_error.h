// How thick may a medium be before the rounding of places decides on its optical depths?
#pragma once
#include <string>

#include "scene/scene.h"

namespace airlight::scene {

// Error of optical depths through rounding of coordinates: the greatest extinction of a medium with a boundary, times
// 2^-53 of its diagonal and of its distance from the camera. 0 without such a medium. The limits of single precision
// are in single_precision.h. The loader's require_resolved checks where a scene lies (coordinates from its origin), and
// one Gaussian at a time: above 1e-4 there are only overlaps of very many Gaussians.
double place_error(const Scene&);

// A line that says that this error is more than `most`; empty if it is not.
std::string too_thick(const Scene&, double most);

}  // namespace airlight::scene
