// The ends of the camera rays: scene::ray_end for every pixel centre, written into storage buffers on the device.
//
// Way::tree, a compute shader: boxes and triangles are skipped in single precision, with a margin for rounding.
// Candidates are intersected in double precision, by the test of scene/geometry/ray_primitive, and the distance is
// stored as a float. So no pixel shows what its centre's ray misses. If surfaces have equal distances as floats, the
// first in the scene is taken.
//
// Way::raster, a raster pass (raster_pass.h): the rasteriser decides what a pixel shows, to 1/256 pixel at silhouettes;
// where it is met is computed in double precision too. Rays through cells of another grid go through the tree.
//
// Either way surfaces are two-sided; there is no near plane, and no far one before 1e37 m.
#pragma once
#include "gpu/program.h"
#include "gpu/raster/raster_pass.h"
#include "gpu/raster/shadow_tree.h"

namespace airlight::gpu {

class FirstHits {
 public:
  enum class Way { tree, raster };
  static void bind(scene::SettingBinder&, Way&);  // the setting first_hits

  // Throws Unavailable if the surfaces pass the device's limits, or for a raster pass if its vertex shaders read no
  // storage buffers.
  FirstHits(Context&, const scene::Scene&, bool with_balls = true, Way = Way::tree);

  const SurfacesOnDevice& surfaces() const { return surfaces_; }
  const ShadowTree& tree() const { return tree_; }
  bool move_balls(const scene::Scene& scene) { return surfaces_.move_balls(scene); }

  // Row 0 first, x fastest: distances along the rays [m] as floats, far_away where nothing is hit, and, unless null,
  // primitives as ints: triangles in their order, then solids, then balls; -1: nothing. Throws Error if they do not fit.
  void find(const scene::View&, const Buffer& distances, const Buffer* primitives = nullptr, const HitGrid& = {}) const;
  // Distances alone, by the tree either way.
  void find(const scene::View&, const Buffer& distances, const CellGrid&) const;

 private:
  void require_program() const;
  void trace(const scene::View&, const Buffer& distances, const Buffer* primitives, const CellGrid&) const;

  Context& context_;
  SurfacesOnDevice surfaces_;
  ShadowTree tree_;
  std::unique_ptr<RasterPass> raster_;  // null: by the tree
  mutable Program* program_ = nullptr;  // for the tree; null: not needed yet
  mutable int dispatches_ = 1;          // that a ray may need, where the device limits loops
  mutable std::unique_ptr<Buffer> unfinished_;
};

}  // namespace airlight::gpu
