// What ends the camera rays: scene::ray_end for every pixel centre, written into storage buffers by a compute shader.
//
// Boxes and triangles are passed over in single precision, with room for its rounding; what may be met is met in double
// precision, by the test of scene/geometry/ray_primitive, and kept as a float. So no pixel shows what its centre's ray
// misses. Surfaces are two-sided; there is no near plane, and no far one before 1e37 m. Of surfaces at one distance, as
// floats, the first in the scene is taken.
#pragma once
#include "gpu/raster/shadow_tree.h"
#include "gpu/raster/surfaces_on_device.h"
#include "scene/renderer.h"

namespace airlight::gpu {

inline constexpr float far_away = 1e37f;  // [m] as the shaders: nothing is hit

// Rays through the centres of blocks of `block` x `block` pixels of a view; the last ones may reach beyond its edge.
struct HitGrid {
  int block = 1;          // pixels, to both sides
  std::size_t first = 0;  // place of the first ray in the buffers, counted in rays

  int columns(const scene::View& view) const { return (view.width + block - 1) / block; }
  int rows(const scene::View& view) const { return (view.height + block - 1) / block; }
};

class FirstHits {
 public:
  // Throws Unavailable if the surfaces pass the device's limits.
  FirstHits(Context&, const scene::Scene&, bool with_balls = true);

  const SurfacesOnDevice& surfaces() const { return surfaces_; }
  const ShadowTree& tree() const { return tree_; }
  bool move_balls(const scene::Scene& scene) { return surfaces_.move_balls(scene); }

  // Row 0 first, x fastest: distances along the rays [m] as floats, far_away where nothing is hit, and, unless null,
  // primitives as ints: triangles in their order, then solids; -1: nothing. Throws Error if they do not fit.
  void find(const scene::View&, const Buffer& distances, const Buffer* primitives = nullptr, const HitGrid& = {}) const;

 private:
  Context& context_;
  SurfacesOnDevice surfaces_;
  ShadowTree tree_;
};

}  // namespace airlight::gpu
