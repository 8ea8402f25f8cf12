// Limits of the half-resolution march.
#pragma once
#include <string>
#include <vector>

#include "reference/half_resolution_march/options.h"
#include "scene/scene.h"

namespace airlight::half_resolution_march {

constexpr double most_work = 1e12;        // points of steps, times lights: a day or so
constexpr double least_endless = 1e-100;  // extinction of fog without end [1/m]: squares of its lengths are finite

// Reasons, one line each, before anything is allocated.
std::vector<std::string> unsupported(const scene::Scene&, const Options&);

}  // namespace airlight::half_resolution_march
