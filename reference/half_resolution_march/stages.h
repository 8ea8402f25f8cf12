// What is done for a scene, and what is left out and why.
#pragma once
#include <vector>

#include "reference/half_resolution_march/passes.h"
#include "scene/renderer.h"

namespace airlight::half_resolution_march {

std::vector<scene::Stage> describe_stages(const Plan&);

// Are film pixels another grid than marched ones, or marched ones blurred at all?
bool blurs(const Plan&);

}  // namespace airlight::half_resolution_march
