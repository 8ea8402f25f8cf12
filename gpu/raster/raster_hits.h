// What ends the camera rays, by a raster pass: scene::ray_end for every pixel centre.
//
// Which surface a pixel shows is decided by the rasteriser, to a fraction of a pixel at silhouettes. Where it is met is
// computed for the pixel's own ray in double precision, from the triangle's plane or the sphere or plane itself, and
// kept as floats. Surfaces are two-sided; there is no near plane (raster/mesh.vert) and none farther than which
// something is lost (raster/hit.glsl). Of surfaces closer to each other than 2^-24 of their distance the first in the
// scene is taken.
#pragma once
#include <memory>
#include <vector>

#include "gpu/raster/hit_image.h"
#include "gpu/raster/surfaces_on_device.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class RasterHits {
 public:
  // Throws Unavailable where the device's vertex shaders read no storage buffers.
  RasterHits(Context&, const scene::Scene&, bool with_balls = true);

  const SurfacesOnDevice& surfaces() const { return surfaces_; }
  bool move_balls(const scene::Scene& scene) { return surfaces_.move_balls(scene); }

  // Draws the view. The image is valid until the next call.
  const HitImage& draw(const scene::View&);

 private:
  Context& context_;
  SurfacesOnDevice surfaces_;
  std::vector<std::unique_ptr<HitImage>> images_;  // of the last two sizes, the latest first
};

}  // namespace airlight::gpu
