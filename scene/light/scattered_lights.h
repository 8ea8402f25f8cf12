// Which lights the media of a scene scatter. Methods skip work on light in the air for all other lights.
#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace airlight::scene {

// Is the light other than 0 in a channel? A black map counts as light: only its scale is looked at.
bool shines(const Light&);

// Does a medium scatter a share of the light, in any channel?
bool scatter(const std::vector<Medium>&, const Light&);

// The lights of which the media scatter something, in the scene's order.
std::vector<Light> scattered_lights(const Scene&);

// Why there are no such lights; empty if there are.
std::string why_nothing_scatters(const Scene&);

}  // namespace airlight::scene
