// How thick may a medium be before the rounding of places decides on its optical depths?
#pragma once
#include <string>

#include "scene/scene.h"

namespace airlight::scene {

// What the rounding of places can do to an optical depth: the greatest extinction of a medium with a boundary, times
// 2^-53 of the lengths in play, its diagonal and its distance from the camera. In single precision 2^29 times that. 0
// without such a medium.
double place_error(const Scene&);

// In one line: that this is more than `most` where places are rounded to `digits` binary digits. Empty if not.
std::string too_thick(const Scene&, int digits, double most);

}  // namespace airlight::scene
