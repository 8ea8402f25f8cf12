// The airbrush: particles that live for ever, diffuse, and bounce off the surfaces of the scene (Zhou et al. 2007,
// section 6).
#pragma once
#include <cstdint>
#include <functional>

#include "methods/fogshop/authoring/gaussian_list.h"
#include "scene/geometry/geometry.h"

namespace airlight::fogshop::authoring {

// Particle k is born at `position` at the time k / rate, as long as that is before steps * dt, and flies off with
// `speed` in a random direction. A step moves a particle by velocity * dt + diffusion * sqrt(dt) * normal; a particle
// born within a step moves for what is left of it.
struct Airbrush {
  Point3 position = Point3::Zero();
  double rate = 1;       // [1/s], > 0
  double speed = 0;      // [m/s], >= 0
  double diffusion = 0;  // [m/sqrt(s)], >= 0
  double dt = 0.1;       // [s], > 0
  int steps = 1;         // >= 0
  Gaussian brush;        // a, c, colour, tag
  std::uint32_t seed = 0;
};

// Particles stay this far off surfaces [m].
inline constexpr double clearance = 1e-4;

// A straight displacement with specular reflection at up to 8 surfaces; what is left after the eighth is dropped. The
// way is only made of pieces that no surface crosses, each of which ends `clearance` before the surface it meets (or
// where it began, if that is nearer): so the path never passes a surface, whatever the rounding. Turns the velocity as
// the displacement. `geometry` may be null.
struct Flight {
  Point3 position;
  Vec3 velocity;
};
Flight bounce(const scene::Geometry* geometry, const Point3& from, Vec3 displacement, const Vec3& velocity);

// Runs the airbrush; particles of earlier strokes that were not frozen move with it. Ids of all that moved or were
// born. `each_step` is called before every step and may throw to stop. Throws Error for more than 1e9 moves.
std::vector<Id> airbrush(
    GaussianList&, const Airbrush&, const scene::Geometry*, const std::function<void()>& each_step = [] {});

// Stops all particles: ids of those that moved.
std::vector<Id> freeze(GaussianList&);

}  // namespace airlight::fogshop::authoring
