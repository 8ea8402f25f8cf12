// Surfaces lit by an environment past smoke and spheres, by directions: CentreSources::irradiance of `transmittance = directional`.
#pragma once
#include "gpu/compensated_ray_marching/marched_smoke.h"
#include "gpu/raster/first_hits.h"
#include "methods/compensated_ray_marching/ordinate_directions.h"

namespace airlight::gpu::compensated_ray_marching {

class SurfacesByDirections {
 public:
  // The density, of Gaussians, outlives this; null: there is no smoke. `middle`: that of the density.
  SurfacesByDirections(Context&, const SmokeDensity*, const Point3& middle,
                       const std::vector<airlight::compensated_ray_marching::Ordinate>&);
  // Into Lit of every pixel. light: [channel][direction], doubles, times the weights. spheres: of centre_surfaces.comp, `count` of them.
  void light(const scene::View&, const SurfacesOnDevice&, const Rgb& sigma_t, const Buffer& light,
             const Buffer& spheres, int count, const Buffer& primitives, const Buffer& lit) const;

 private:
  const SmokeDensity* density_;
  Point3 middle_;
  int directions_;
  Program& program_;
  Buffer towards_;
};

}  // namespace airlight::gpu::compensated_ray_marching
