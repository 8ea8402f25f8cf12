// Density and source radiance at the voxels of fitted smoke, on the device: methods/compensated_ray_marching/smoke_volume.h.
#pragma once
#include <memory>

#include "gpu/compensated_ray_marching/interface.h"
#include "gpu/compensated_ray_marching/residual_store.h"
#include "methods/compensated_ray_marching/marched_smoke.h"

namespace airlight::gpu::compensated_ray_marching {

class SmokeVolume {
 public:
  // The smoke has voxels, and its residual is stored as bricks or hash. It must outlive this object.
  SmokeVolume(Context&, const airlight::compensated_ray_marching::SmokeField&);

  // sources: of each centre towards the camera, as CentreSourcesOnDevice has them.
  void find(const Buffer& sources) const;
  // By voxel: source radiance times density, density.
  const Buffer& values() const { return *values_; }

 private:
  const airlight::compensated_ray_marching::SmokeField& smoke_;
  std::unique_ptr<compensated_ray_marching::ResidualOnDevice> residual_;  // null: there is none
  std::unique_ptr<Buffer> gaussians_, values_;
  int count_ = 0;
  Program* program_ = nullptr;
};

}  // namespace airlight::gpu::compensated_ray_marching
