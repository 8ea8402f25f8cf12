// The volume pass: density and source radiance at the voxels of fitted smoke, interpolated between them along the rays.
// Zhou et al. 2008, Eq. 15, sections 5.5 and 5.6.
#pragma once
#include <array>
#include <vector>

#include "methods/compensated_ray_marching/marched_smoke.h"
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {

class SmokeVolume {
 public:
  // A voxel: source radiance times density, density.
  using Values = std::vector<std::array<float, 4>>;
  struct Sample {
    double density = 0;
    Rgb source = Rgb::Zero();  // radiance
  };

  // `smoke` has voxels and must outlive this object. Density is max(0, D~ + R), and 0 where the
  // Gaussians are below least_density().
  SmokeVolume(const SmokeField&, const scene::Execution&);

  // towards: source radiance of each centre. At a voxel that is the mean of the centres', weighted with their Gaussians, and at least 0.
  Values values(const std::vector<Rgb>& towards, const scene::Execution&) const;
  // Trilinear between voxels, as scene::density of their grid.
  Sample between(const Values&, const Point3&) const;

 private:
  const SmokeField& smoke_;
  std::vector<float> densities_;
};

}  // namespace airlight::compensated_ray_marching
