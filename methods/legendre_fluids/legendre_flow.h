// A fluid of coefficients as a scene::Flow: metres, sources, forces, states.
#pragma once
#include <memory>

#include "methods/legendre_fluids/fluid.h"
#include "scene/flow.h"

namespace airlight::legendre_fluids {

enum class Mixing {
  densities,  // each density moves
  albedo,  // of two the sum r and the first one's share a: densities are the products a r and r - a r, cut to n (the paper's section 7)
};

// Starts the fluid with what the problem has at first. `cells` are those of frames and of media that are grids, along the longest axis.
// Throws Error where a region of a source or force is too small to be seen.
std::unique_ptr<scene::Flow> start_flow(std::shared_ptr<const scene::FlowProblem>, std::unique_ptr<Fluid>, int cells,
                                        Mixing);

}  // namespace airlight::legendre_fluids
