// Stages of froxel fog for a scene seen by its own camera, and the stages that are left out and why.
#pragma once
#include <string>
#include <vector>

#include "reference/froxel_fog/options.h"
#include "scene/renderer.h"

namespace airlight::froxel_fog {

// `settings`: the effective ones as text.
std::vector<scene::Stage> describe_stages(const lit_media::Plan&, const Options&, const std::string& settings);

}  // namespace airlight::froxel_fog
