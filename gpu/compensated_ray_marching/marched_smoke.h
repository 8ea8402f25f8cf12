// The density that camera rays march through, on the device: a sum of Gaussians or a voxel grid, cut off by a region.
#pragma once
#include <memory>

#include "gpu/compensated_ray_marching/interface.h"
#include "methods/compensated_ray_marching/marched_smoke.h"

namespace airlight::gpu::compensated_ray_marching {

class SmokeDensity {
 public:
  // Uploads the field of the smoke, of which `unsupported_smoke` names nothing. Places on the device are relative to `middle` [m]. With
  // `paper` the march also interpolates the source radiance between the centres of the Gaussians, or between voxels (SmokeVolume).
  SmokeDensity(Context&, const airlight::compensated_ray_marching::SmokeField&, const Point3& middle, bool paper);
  // Uploads Gaussians that no region cuts off.
  SmokeDensity(Context&, const scene::GaussianSum&, const Point3& middle);

  const Definitions& definitions() const { return definitions_; }
  void bind(Program&) const;
  // Length of the longest way through it [m].
  double longest() const { return longest_; }
  double widths2() const { return widths2_; }  // of a Gaussian: where it ends, squared
  int slices() const { return slices_; }       // of a ray in one dispatch

 private:
  void set_gaussians(Context&, const scene::GaussianSum&, const Point3& middle);
  void set_voxels(Context&, const scene::VoxelGrid&, const Point3& middle);
  void set_region(const scene::Region&, const Point3& middle);

  int slices_;
  std::unique_ptr<Buffer> values_;
  Definitions definitions_;
  double longest_ = 0, widths2_ = 0, farthest_ = 0, border_ = 0;
  int count_ = 0, region_kind_ = 0;
  Vec3 region_a_ = Vec3::Zero(), region_b_ = Vec3::Zero();
  Vec3 samples_ = Vec3::Zero(), middle_sample_ = Vec3::Zero();
  Mat3 to_samples_ = Mat3::Identity();
};

// Why the device does not march through a medium; empty: it does.
std::vector<std::string> unsupported_smoke(const scene::Scene&);

}  // namespace airlight::gpu::compensated_ray_marching
