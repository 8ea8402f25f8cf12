// First hits by the rasteriser (first_hits.h).
//
// Which surface a pixel shows is decided to a fraction of a pixel at silhouettes. The hit point is computed for the
// pixel's own ray in double precision, from the triangle's plane or the sphere or plane itself, and stored as floats.
// There is no near plane (raster/mesh.vert), and the far plane loses nothing (raster/hit.glsl). If surfaces are closer
// to each other than 2^-24 of their distance, the first in the scene is taken.
#pragma once
#include <memory>
#include <vector>

#include "gpu/raster/hit_image.h"
#include "gpu/raster/surfaces_on_device.h"
#include "gpu/raster_program.h"
#include "scene/renderer.h"

namespace airlight::gpu {

// Rays through the centres of blocks of `block` x `block` pixels of a view; the last ones may reach beyond its edge.
struct HitGrid {
  int block = 1;          // pixels, to both sides
  std::size_t first = 0;  // place of the first ray in the buffers, counted in rays

  int columns(const scene::View& view) const { return (view.width + block - 1) / block; }
  int rows(const scene::View& view) const { return (view.height + block - 1) / block; }
};

// Rays through one place of each cell of a grid over the film of a view.
struct CellGrid {
  int columns, rows;
  double width, height;   // of a cell [pixels]
  double x, y;            // the place, from 0 to 1 of a cell
  std::size_t first = 0;  // as in HitGrid
  bool cut = false;       // cells that reach beyond the film's edge end there
};

class RasterPass {
 public:
  // Throws Unavailable where the device's vertex shaders read no storage buffers.
  explicit RasterPass(Context&);

  // Like FirstHits::find, with buffers that are large enough.
  void find(const SurfacesOnDevice&, const scene::View&, const Buffer& distances, const Buffer* primitives,
            const HitGrid&);

 private:
  HitImage& image(int width, int height);

  Context& context_;
  RasterProgram &mesh_, &solid_;
  std::unique_ptr<Buffer> rectangles_;
  std::vector<std::unique_ptr<HitImage>> images_;  // of the last two sizes, the latest first
};

}  // namespace airlight::gpu
