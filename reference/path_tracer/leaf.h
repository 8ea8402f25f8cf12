// Samples of one leaf (64 consecutive numbers, or fewer at the end of a range) of one pixel or detector.
#pragma once
#include <functional>

#include "reference/path_tracer/path.h"
#include "reference/path_tracer/tally.h"

namespace airlight::path_tracer {

// A detector: the ray of a sample from two uniforms of its own (fine(0) and fine(1) of the block).
using RaySource = std::function<Ray(const RandomBlock&)>;

// Samples [first, first + count) along one ray.
// `pixel` names the random numbers. Throws Error, beginning with `where`, for a sample that is not finite.
void add_samples(const World&, const CameraRay&, std::uint32_t pixel, std::uint64_t first, std::uint64_t count,
                 const TallyLayout&, double* sums, Counters&, const std::function<std::string()>& where);
// Samples [first, first + count), each along its own ray.
void add_samples(const World&, const RaySource&, std::uint32_t pixel, std::uint64_t first, std::uint64_t count,
                 const TallyLayout&, double* sums, Counters&, const std::function<std::string()>& where);

}  // namespace airlight::path_tracer
