// Limits of the ray marcher: it refuses steps whose length is out of range, and more work or memory than
// a user would wait for.
#pragma once
#include <string>
#include <vector>

#include "reference/ray_marcher/options.h"
#include "scene/scene.h"

namespace airlight::ray_marcher {

constexpr double most_steps = 1 << 17;                    // of a ray
constexpr double least_length = 1e-3, most_length = 1e6;  // of a step, in voxels (metres without a grid)
constexpr double most_work = 1e14;                        // density evaluations in a picture, at most: a day or so
constexpr double most_ray_steps = 1 << 22;  // of one ray, its marches for lights included: what is in memory

// Steps that a camera ray takes at most, before deep ones are divided; `unit` as of read_options.
double steps_per_ray(const scene::Scene&, const Options&);

// Reasons, one line each, before anything is allocated.
std::vector<std::string> unsupported(const scene::Scene&, const Options&, double unit);

}  // namespace airlight::ray_marcher
