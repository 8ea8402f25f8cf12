// Limits of the quadrature: it refuses more work than a user would wait for.
#pragma once
#include <string>

#include "scene/scene.h"

namespace airlight::deterministic {

constexpr double most_work = 1e14;  // terms of densities in a picture, some 10 ns each: ten days of one processor

// Terms on the way from one node to the light.
double terms_of_evaluation(const scene::Scene&);

// Terms of densities that the first panels along one ray sum up, to an order of magnitude: panels of every light, times
// the terms on the way from a node to the light. Refinement by the tolerance comes on top.
double terms_of_ray(const scene::Scene&);

// In one line: that a picture of the scene needs more than most_work. Empty if not.
std::string unsupported(const scene::Scene&);

}  // namespace airlight::deterministic
