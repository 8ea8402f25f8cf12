// m where camera rays begin, on the device: how many surfaces lie between a light and there
// (methods/shadow_planes/surface_count.h), by the tree of raster/shadow_tree.h.
#pragma once
#include "gpu/raster/first_hits.h"
#include "gpu/shadow_planes/silhouette.h"

namespace airlight::gpu::shadow_planes {

class OriginCounts {
 public:
  // All must live on.
  OriginCounts(Context&, const Silhouettes&, const FirstHits&);

  // Of a perspective camera into the light's state; of a parallel view by pixel into `states` (state.glsl). Loops that
  // the driver ends are told in `counters`.
  void find(const scene::View&, const Point3& light, const LightEdges&, const Buffer& states,
            const Buffer& counters) const;

 private:
  Context& context_;
  const Silhouettes& silhouettes_;
  const FirstHits& surfaces_;
  mutable Program* programs_[2] = {nullptr, nullptr};  // at the camera, by pixel
};

}  // namespace airlight::gpu::shadow_planes
