// The particle emitter (Reeves 1983; Zhou et al. 2007, section 6): parabolic paths, a Gaussian at every living
// particle.
#pragma once
#include <cstdint>

#include "methods/fogshop/authoring/gaussian_list.h"

namespace airlight::fogshop::authoring {

// Particle k is born at t0 + k / rate, before t1, and gone at the age `life`. With s = age / life it has
// a = a0 + (a1 - a0) s and c = c0 + (c1 - c0) s. "The longer the particle lives, the smaller its scale and amplitude":
// c1 <= c0. Scale is the paper's a where it speaks of the paintbrush (a1 < a0: smoke widens); the width where one reads
// it as size (a1 > a0). Both are accepted.
struct Emitter {
  Point3 position = Point3::Zero();
  double rate = 1;                   // [1/s], > 0
  Vec3 velocity = Vec3::Zero();      // [m/s], v0
  double spread = 0;                 // [m/s], >= 0: radius of the ball that is added to v0
  Vec3 acceleration = Vec3::Zero();  // [m/s^2]
  double life = 1;                   // [s], > 0
  double a0 = 1, a1 = 1;             // [1/m], > 0
  double c0 = 1, c1 = 0;             // [1/m], c0 > 0, 0 <= c1 <= c0
  double t0 = 0, t1 = 1;             // [s], t0 <= t1
  Rgb color = Rgb::Ones();
  std::string tag;
  std::uint32_t seed = 0;
};

// The Gaussians at `time` [s], in order of birth: a pure function. Throws Error above the greatest number of a list.
std::vector<Gaussian> particles(const Emitter&, double time);

}  // namespace airlight::fogshop::authoring
