// The smallest scenes that use what a method computes on a device, made in code: they need no files.
#pragma once
#include <memory>

#include "scene/flow/flow_problem.h"
#include "scene/scene.h"

namespace airlight::experiments::small {

using ScenePointer = std::shared_ptr<const scene::Scene>;

ScenePointer smoke_in_room();        // Gaussians, a lamp, a floor and a box
ScenePointer haze_in_room();         // smoke_in_room with a constant density around the smoke
ScenePointer shadow_of_box();        // homogeneous fog in the room
ScenePointer smoke_under_sky();      // Gaussians that end at 3 widths, an uneven environment, a floor
ScenePointer map_of_fog();           // a fogmap, a lamp, a floor
ScenePointer polynomial_of_smoke();  // a Legendre box under a directional light

std::shared_ptr<const scene::FlowProblem> warm_swirl();  // two scalars, buoyancy, a source, diffusion, decay

}  // namespace airlight::experiments::small
