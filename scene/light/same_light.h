// Is a light of the next frame the light of this one?
#pragma once
#include "scene/light/light.h"

namespace airlight::scene {

// All values are equal, bit by bit; maps of environments are one and the same object.
bool same_light(const Light&, const Light&);
// Their rays are the same, and so are optical depths along them; their power may differ. For lights that shine from one direction (is_delta).
bool same_rays(const Light&, const Light&);

}  // namespace airlight::scene
