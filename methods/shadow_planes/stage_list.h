// The stages that a scene needs, and the stages that are left out, with the reasons.
#pragma once
#include "methods/shadow_planes/options.h"
#include "scene/renderer.h"

namespace airlight::shadow_planes {

struct StageNeeds {
  std::size_t lights;  // that the media scatter
  bool shadows, surfaces;
  bool paper_stages;  // the paper's, not lit parts of rays
  std::size_t edges;  // of all lights
};
std::vector<scene::Stage> stage_list(const scene::Scene&, const Options&, const StageNeeds&);

}  // namespace airlight::shadow_planes
