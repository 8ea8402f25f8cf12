// Scenes like a given one: for judging what was found in some.
#pragma once
#include <memory>

#include "scene/scene.h"

namespace airlight::experiments {

// The scene with its extinctions, albedos, lights and camera changed at random, by numbers that depend on `variation` alone. 0: as it is.
//
//   extinction   times 0.4 to 2.5
//   albedo       its distance to 1 times 0.4 to 2.5
//   point, spot  moved by up to a fifth of the distance to the camera along each axis, not through surfaces
//   directional  turned by up to 1 rad about the y axis, its height above the horizon times 0.6 to 1.5
//   environment  turned about the y axis
//   camera       turned by up to 0.3 rad about the middle of media, or on the spot where they have none; field of view times 0.85 to 1.15
std::shared_ptr<const scene::Scene> varied(const scene::Scene&, int variation);

}  // namespace airlight::experiments
