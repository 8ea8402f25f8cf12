// The environments of a scene together.
#pragma once
#include "scene/scene.h"

namespace airlight::scene {

bool has_environment(const Scene&);

// What they send from this direction [W/m^2/sr]: what a camera ray sees that meets nothing, without the medium.
Rgb background(const Scene&, const Vec3& direction);

}  // namespace airlight::scene
