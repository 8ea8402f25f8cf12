// Radiance along single rays, and means over detectors, by scattering order: what oracles are compared with.
#pragma once
#include <vector>

#include "reference/path_tracer/leaf.h"
#include "scene/renderer.h"

namespace airlight::path_tracer {

struct Estimate {
  Rgb mean = Rgb::Zero();
  Rgb error = Rgb::Zero();  // standard error of the mean
};

struct RadianceEstimate {
  std::uint64_t samples = 0;
  Estimate total;
  std::vector<Estimate> orders;  // 0 .. K, then the rest
  Rgb airlight = Rgb::Zero();    // (m, s) = (1, 0)
  Rgb surface = Rgb::Zero();     // (0, s)
  Rgb truncated = Rgb::Zero();
  Rgb greatest = Rgb::Zero();  // sample
  std::vector<Rgb> batches;    // sixteen means of equal shares of the samples, if samples is a multiple of 16
  Counters counters;
};

// `samples` paths, on all threads of the execution; the same bits for any number of them. `index` names the random
// numbers, as a pixel does. Throws Error as render_range does, Interrupted if stopped.
RadianceEstimate radiance(const World&, const Ray&, std::uint64_t samples, const scene::Execution& = {},
                          std::uint32_t index = 0);
RadianceEstimate mean_radiance(const World&, const RaySource&, std::uint64_t samples, const scene::Execution& = {},
                               std::uint32_t index = 0);

}  // namespace airlight::path_tracer
