// The directions that light is gathered from, and what comes from each of them without the smoke.
#pragma once
#include <vector>

#include "methods/compensated_ray_marching/environment_bands.h"
#include "methods/compensated_ray_marching/ordinate_directions.h"

namespace airlight::compensated_ray_marching {

// Environments are taken with `levels` bands of spherical harmonics, at levels x 2 levels Gauss directions, whose rule is exact for their
// products with as many bands of what the smoke leaves of them. Directional lights follow, each a direction of its own.
class IncomingLight {
 public:
  // With as many levels as the bands have order.
  IncomingLight(const std::vector<scene::Light>&, EnvironmentBands);
  // Whether other lights have the same fixed directions: those of environments are left out where directional lights are all.
  bool fits(const std::vector<scene::Light>&) const;
  // Other lights, which fit.
  void become(const std::vector<scene::Light>&);

  const std::vector<Vec3>& directions() const { return directions_; }  // towards the light, unit
  std::size_t fixed() const { return fixed_.size(); }                  // directions of environments, which come first
  const std::vector<Ordinate>& fixed_directions() const { return fixed_; }
  const std::vector<Rgb>& power() const { return power_; }  // radiance times solid angle, or irradiance [W/m^2]
  // Upper bound of the source radiance of smoke, per albedo: the brightest radiance of the sky; infinite
  // with a sun [W/m^2/sr].
  Rgb brightest() const;
  bool dark() const;
  bool grey() const;  // equal in all channels

 private:
  EnvironmentBands bands_;
  std::vector<Ordinate> fixed_;
  std::vector<Vec3> directions_;
  std::vector<Rgb> power_;
};

}  // namespace airlight::compensated_ray_marching
