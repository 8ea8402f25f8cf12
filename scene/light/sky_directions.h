// Directional lights that stand for an environment.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace airlight::scene {

// `count` directional lights: direction k is the environment's own sample for the k-th point of a Fibonacci lattice in the
// unit square, with irradiance radiance / (pdf * count). For a map that follows its luminance, mixed with 5 % uniform; for
// a constant it is the spherical Fibonacci set. Directions without radiance are left out.
std::vector<DirectionalLight> environment_as_lights(const EnvironmentLight&, int count);

// A scene's lights for methods that know light from one direction alone: each environment is `count` directional lights. Lights infinitely far
// away are left out where `swallowed`.
std::vector<Light> lights_from_directions(const std::vector<Light>&, int count, bool swallowed);

// The scene with so many directional lights for each of its environments, which stay in it as backgrounds.
Scene with_sky_as_lights(const Scene&, int count);

// Has a medium no end in any direction, and extinguishes in all channels: no light comes in from infinitely far away.
bool swallows_distant_light(const std::vector<Medium>&);

}  // namespace airlight::scene
