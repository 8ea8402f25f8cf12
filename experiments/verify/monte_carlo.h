// Measurements with the path tracer, for vectors that have no noise-free answer here.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "experiments/verify/check.h"
#include "reference/path_tracer/single_rays.h"
#include "scene/scene.h"

namespace airlight::experiments::verification {

// Two standard errors apart this often, by chance: 4.5 se once in 1.5e5 normal comparisons (references.md, section 6).
inline constexpr double accept_se = 4.5;

// How far to go: until the standard error of the total is below `se`, as foretold by a pilot of other random numbers (a
// stop by the samples themselves would be biased), but at least `least` and at most `most` samples.
struct Effort {
  double se = 0;
  std::uint64_t most = 1 << 20;
  std::uint64_t least = 1 << 14;
};

using Detector = path_tracer::RaySource;

// Means over a detector's rays, or of one ray. `name` picks the random numbers: other names, other numbers.
path_tracer::RadianceEstimate measure(const scene::Scene&, const Detector&, int orders, const Effort&,
                                      const std::string& name);
path_tracer::RadianceEstimate measure(const scene::Scene&, const Ray&, int orders, const Effort&,
                                      const std::string& name);

// Rays from `origin`, cosine-weighted about `axis`: their mean radiance times pi is the flux through a plane.
Detector cosine_detector(const Point3& origin, const Vec3& axis);
// Rays from one point in all directions.
Detector isotropic_detector(const Point3& origin);

// A direction at cosine mu to z, in the xz plane; with the sign of mu.
Vec3 slanted(double mu);

}  // namespace airlight::experiments::verification
