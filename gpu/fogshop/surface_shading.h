// Surfaces in shaders: direct light with shadows, and scattered light (methods/fogshop/surface_pass.h).
#pragma once
#include <memory>

#include "gpu/fogshop/passes.h"
#include "gpu/raster/light_distances.h"
#include "methods/fogshop/scattered_reflection.h"

namespace airlight::gpu {

class SurfaceShading {
 public:
  // Uploads materials, light positions and the NPSF's harmonics (`reflection`, null: direct light alone).
  SurfaceShading(Context&, const scene::Scene&, const fogshop::Model&, const fogshop::ScatteredReflection* reflection);

  // Light-distance maps of `side` texels to a face, where anything can cast a shadow (casts_shadows).
  void fill_light_distances(int side);

  // e^-T L_p of every pixel, 3 floats each: `pixels` as FogOnDevice::airlight left them (null: there is no medium),
  // `primitives` as the first hits did. The scattered part into `scattered` too, if it is there.
  void shade(FogOnDevice&, const SurfacesOnDevice&, const scene::View&, const Buffer& primitives, const Buffer* pixels,
             const Buffer& surface, const Buffer* scattered);

 private:
  Context& context_;
  const scene::Scene& scene_;
  const fogshop::Model& model_;
  double magnitude_;  // the largest coordinate [m]
  bool scattered_;
  Buffer materials_, light_places_, harmonics_;
  std::unique_ptr<LightDistances> maps_;  // null: nothing casts a shadow
};

// A lone plane or sphere shadows itself only where it is turned away.
bool casts_shadows(const scene::Scene&);

}  // namespace airlight::gpu
