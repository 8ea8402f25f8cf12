// A changed copy of a finished scene, ready for renderers.
#pragma once
#include "scene/scene.h"

namespace airlight::scene {

// As finish(), for a copy of a finished scene whose surfaces are unchanged: it keeps its geometry.
void finish_copy(Scene&);

}  // namespace airlight::scene
