// Random numbers of the authoring operations: functions of (seed of the operation, index of the Gaussian, step), of
// nothing else, so that a script gives the same fog everywhere.
#pragma once
#include <cmath>
#include <cstdint>

#include "scene/math/random.h"
#include "scene/math/types.h"

namespace airlight::fogshop::authoring {

class Draws {
 public:
  Draws(std::uint32_t seed, std::uint32_t index) : seed_(seed), index_(index) {}

  // A pair of uniforms in (0, 1), the same at every call.
  RandomBlock uniforms(std::uint64_t step, std::uint32_t which) const {
    return SampleRandom(seed_, 0, index_, step).block(0, Purpose::camera, which);
  }
  // Uniform in the disc of radius 1, its rim left out.
  Eigen::Vector2d disc() const {
    const RandomBlock u = uniforms(0, 0);
    // The rounding of root, cosine and sine must not carry a point to the rim.
    const double rho = std::sqrt(u.fine(0)) * (1 - 1e-14), phi = 2 * pi * u.fine(1);
    return {rho * std::cos(phi), rho * std::sin(phi)};
  }
  // Uniform on the sphere of radius 1.
  Vec3 sphere() const {
    const RandomBlock u = uniforms(0, 0);
    const double z = 2 * u.fine(0) - 1, phi = 2 * pi * u.fine(1), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  // Uniform in the ball of radius 1.
  Vec3 ball() const { return std::cbrt(uniforms(0, 1).fine(0)) * sphere(); }
  // Three independent normals of variance 1 (Box and Muller 1958).
  Vec3 normals(std::uint64_t step) const {
    const RandomBlock one = uniforms(step, 2), two = uniforms(step, 3);
    const double r = std::sqrt(-2 * std::log(one.fine(0))), s = std::sqrt(-2 * std::log(two.fine(0)));
    return {r * std::cos(2 * pi * one.fine(1)), r * std::sin(2 * pi * one.fine(1)), s * std::cos(2 * pi * two.fine(1))};
  }

 private:
  std::uint32_t seed_, index_;
};

}  // namespace airlight::fogshop::authoring
