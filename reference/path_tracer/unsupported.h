// Scenes that the path tracer refuses, and why: scenes without a finite answer, or without one in finite time.
#pragma once
#include <string>
#include <vector>

#include "reference/path_tracer/options.h"
#include "scene/scene.h"

namespace airlight::path_tracer {

// One line per reason; empty if there is none. What is detected:
//   - a medium of albedo 1 that is unbounded, or more than 10^4 optical depths thick in its thinnest direction, without
//     a cap on the order: a path has about the square of that many collisions
//   - a point or spot light of radius 0 at the position of a perspective camera that lies in a medium: every pixel is
//     infinite
//   - a closed room of albedo 1 with a light in it: no ray in 4096 from the camera leaves it, all surfaces that they
//     meet and all media reflect everything in one channel, and a light shines inside
//   - more work than 10^14 terms of densities (ten days of one processor): pixels times samples times collisions times
//     Gaussians; or that many to bound the Gaussians in the cells of the supergrid
//   - more than 2^28 cells of supergrids (1 GB)
//   - coloured extinction with ratio tracking, which needs exact densities
std::vector<std::string> unsupported(const scene::Scene&, const Options&);

}  // namespace airlight::path_tracer
