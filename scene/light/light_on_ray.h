// Lights without extent so close to a pixel's ray that a renderer cannot tell how close.
#pragma once
#include <string>

#include "scene/renderer.h"

namespace airlight::scene {

// Throws Error, beginning with `who`, if a point or spot light of radius 0 inside a medium is seen within `share` of
// its distance from the ray through a pixel's centre: the airlight there goes with 1 over that distance. Cost: a ray
// for every light.
void require_lights_apart(const Scene&, const View&, double share, const std::string& who);

}  // namespace airlight::scene
