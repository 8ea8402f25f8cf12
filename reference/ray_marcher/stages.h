// Stages of the ray marcher for a scene, and the stages that are left out and why: on the CPU and on the GPU alike.
#pragma once
#include <vector>

#include "reference/ray_marcher/plan.h"
#include "scene/renderer.h"

namespace airlight::ray_marcher {

std::vector<scene::Stage> describe_stages(const Plan&);

}  // namespace airlight::ray_marcher
