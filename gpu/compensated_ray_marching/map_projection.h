// Projection of a lat-long map on spherical harmonics, on the device: project_environment of scene/light/environment.h, for the texels that lie
// there. With the map's pole as axis the sums separate: Fourier sums of the rows, then sums over rows.
#pragma once
#include "gpu/compensated_ray_marching/interface.h"
#include "scene/light/environment.h"

namespace airlight::gpu::compensated_ray_marching {

class MapProjection {
 public:
  MapProjection(Context&, int order);

  // order^2 coefficients of the map's directions; waits for the device. Closed forms are met to 1e-12, project_environment to what it
  // promises.
  std::vector<Rgb> of(const scene::EnvironmentMap&, const Buffer& texels);

 private:
  void prepare(int width, int height);

  Context& context_;
  int order_;
  Program &rows_, &bands_;
  int width_ = 0, height_ = 0;  // of the tables
  std::unique_ptr<Buffer> circle_, row_weights_, fourier_, projected_;
};

}  // namespace airlight::gpu::compensated_ray_marching
