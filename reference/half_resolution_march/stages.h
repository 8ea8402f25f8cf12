// Stages for a scene, and the stages that are left out and why.
#pragma once
#include <vector>

#include "reference/half_resolution_march/passes.h"
#include "scene/renderer.h"

namespace airlight::half_resolution_march {

std::vector<scene::Stage> describe_stages(const lit_media::Plan&, const Options&);

}  // namespace airlight::half_resolution_march
