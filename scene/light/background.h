// What is behind a medium but surfaces: the environments of a scene together, its backdrops.
#pragma once
#include "scene/scene.h"

namespace airlight::scene {

bool has_environment(const Scene&);

// What they send from this direction [W/m^2/sr]: what a camera ray sees that meets nothing, without the medium.
Rgb background(const Scene&, const Vec3& direction);

// What a camera ray that meets no surface ends on sends: a backdrop, the environments, nothing from a light's ball.
Rgb background(const Scene&, const RayEnd&, const Vec3& direction);

}  // namespace airlight::scene
