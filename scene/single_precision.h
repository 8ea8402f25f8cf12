// Range of scenes that a renderer in 32-bit floats (1.2e-38 to 3.4e38) can hold.
//
// Lengths are 1e-4 to 1e6 m, extinction 1e-9 to 1e9 per metre, light 1e-9 to 1e12 (or 0), |g| at most 0.999, so that
//   (distance/width)^2 of a Gaussian              at most 1e20
//   optical depth                                 1e-13 to 1e15
//   intensity / d^2                               1e-21 to 1e20
//   extinction * length * phase * intensity / d^2 1e-34 to 1e34 (phase function 4e-5 to 1.6e5; as mean 1, 12 times
//   that)
// Places are rounded to 6e-8 of them: extinction times the largest coordinate of the camera and the medium is 3e4 at
// most.
#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace airlight::scene {

// Values of the scene outside this range, one line each; empty if there are none.
std::vector<std::string> beyond_single_precision(const Scene&);

}  // namespace airlight::scene
