// m where camera rays begin, on the device: how many surfaces lie between a light and there
// (methods/shadow_planes/surface_count.h), by the tree of raster/shadow_tree.h.
#pragma once
#include "gpu/raster/first_hits.h"
#include "gpu/shadow_planes/silhouette.h"

namespace airlight::gpu::shadow_planes {

class OriginCounts {
 public:
  // The arguments must outlive this object.
  OriginCounts(Context&, const Silhouettes&, const FirstHits&);

  // For a perspective camera writes m into the light's state; for a parallel view writes m of each pixel into `states`
  // (state.glsl). `counters` report loops that the driver cuts.
  void find(const scene::View&, const Point3& light, const LightEdges&, const Buffer& states,
            const Buffer& counters) const;

 private:
  Context& context_;
  const Silhouettes& silhouettes_;
  const FirstHits& surfaces_;
  mutable Program* programs_[2] = {nullptr, nullptr};  // at the camera, by pixel
};

}  // namespace airlight::gpu::shadow_planes
