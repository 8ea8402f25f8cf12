// The maps of a plan's lights (reference/light_map), filled by the marcher's kernels.
#pragma once
#include "reference/ray_marcher/plan.h"

namespace airlight::ray_marcher {

// Is shadow = map, and does a step or a surface ask for a depth?
bool needs_maps(const Plan&);

// One for each light, into Plan::maps, where they are needed. `before`: of the frame before, whose maps are shared where they still hold; may
// be null. Throws Error where they do not fit into memory. Asks the execution
// for threads, and whether to stop.
void make_light_maps(Plan&, const scene::Execution&, const Plan* before = nullptr);

// The varying densities of the media, by the kernels of the layers, which must live as long; by the media's own
// functions for layers without kernel.
light_map::Densities densities_by_kernels(const std::vector<Layer>&, const std::vector<scene::Medium>&);

// Density evaluations in a picture's maps, at most.
double map_work(const scene::Scene&, const Options&);

}  // namespace airlight::ray_marcher
