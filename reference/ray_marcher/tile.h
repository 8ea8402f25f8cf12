// The fast path: a tile of camera rays at once, all their steps as arrays, so that the vector kernels have enough to
// do.
//
// The same scheme, and the same steps, as scalar.h, in float where kernels run. Stages: rays and steps (double),
// densities, transmittances, then per light: directions, occlusion, shadow columns, scattering; last the surfaces
// behind.
#pragma once
#include "reference/ray_marcher/plan.h"
#include "reference/ray_marcher/scalar.h"

namespace airlight::ray_marcher {

// Pixels of the rays, in their order; thread-safe. `Ray`s near each other make the kernels more efficient.
std::vector<Pixel> march_tile(const Plan&, const std::vector<Ray>&, Counters&);

}  // namespace airlight::ray_marcher
