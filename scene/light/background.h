// Radiance behind a medium, without surfaces: the environments of a scene together, and its backdrops.
#pragma once
#include "scene/scene.h"

namespace airlight::scene {

bool has_environment(const Scene&);

// Radiance of the environments from this direction [W/m^2/sr], seen by a camera ray that meets nothing,
// without the medium.
Rgb background(const Scene&, const Vec3& direction);

// Radiance at the end of a camera ray that meets no surface: a backdrop, the environments, or nothing
// from a light's ball.
Rgb background(const Scene&, const RayEnd&, const Vec3& direction);

}  // namespace airlight::scene
