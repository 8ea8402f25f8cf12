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

// Effort of a render: until the standard error of the total is below `se`, as predicted by a pilot with other random
// numbers (a stop by the samples themselves would be biased). At least `least` samples, at most `most` samples or about
// `collisions` collisions. A render that does not reach `se` has a larger standard error, and is judged by that.
struct Effort {
  double se = 0;  // 0: `least` samples
  std::uint64_t least = 1 << 14;
  std::uint64_t most = std::uint64_t(1) << 24;
  double collisions = 1e7;
  double refused = 1e8;  // collisions; of what may take more, nothing is begun
};
Effort fixed(std::uint64_t samples, VerifyProfile);
// The quick profile's limits of collisions, or a hundred times those.
Effort aim(double se, VerifyProfile);

using Detector = path_tracer::RaySource;

// A scene with rays to look along, and the scattering orders to be told apart. Copies share the scene.
class Measurement {
 public:
  // `name` picks the random numbers: other names, other numbers.
  Measurement(const scene::Scene&, Detector, int orders, std::string name);
  Measurement(const scene::Scene&, const Ray&, int orders, std::string name);

  // All throw Error, before they begin, where the samples or the pilot may take more collisions than `refused`.

  // Collisions that the effort's standard error takes, foretold by the pilot.
  double collisions_for(const Effort&) const;
  path_tracer::RadianceEstimate run(const Effort&) const;

  // Mean collisions per path and its standard error, from sixteen repeats with their own random numbers. Absorption is
  // played: a path survives a collision with the probability of the albedo.
  path_tracer::Estimate collisions(const Effort&) const;

 private:
  void check(std::uint64_t samples, const Effort&) const;
  path_tracer::RadianceEstimate trace(std::uint64_t samples, std::uint32_t stream, std::uint32_t repeat,
                                      bool analog = false) const;
  std::shared_ptr<const scene::Scene> scene_;
  Detector detector_;  // empty: the one ray
  Ray ray_;
  int orders_;
  std::string name_;
};

// Rays from `origin`, cosine-weighted about `axis`: their mean radiance times pi is the flux through a plane.
Detector cosine_detector(const Point3& origin, const Vec3& axis);
// Rays from one point in all directions.
Detector isotropic_detector(const Point3& origin);

// A direction at cosine mu to z, in the xz plane; with the sign of mu.
Vec3 slanted(double mu);

}  // namespace airlight::experiments::verification
