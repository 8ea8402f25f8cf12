// Silhouette edges by their angle around the line from light to camera, on the device
// (methods/shadow_planes/edge_fan.h).
#pragma once
#include <memory>

#include "gpu/shadow_planes/silhouette.h"
#include "scene/camera.h"

namespace airlight::gpu::shadow_planes {

class FanOnDevice {
 public:
  explicit FanOnDevice(Context&, int most_edges);

  // Sorts a light's edges for all rays of a camera. An edge is in four lists at most: there is always room.
  void fill(const scene::Camera&, const Point3& light, const LightEdges&);

  // Binds the lists, sets the uniforms of fan.glsl.
  void bind(LinkedProgram&) const;

 private:
  Context& context_;
  Buffer sectors_, lists_;
  Program *count_, *begin_, *list_;
  Vec3 x_, y_;
};

}  // namespace airlight::gpu::shadow_planes
