// Silhouette edges by their angle around the line from light to camera, on the device
// (methods/shadow_planes/edge_fan.h).
#pragma once
#include <memory>

#include "gpu/linked_program.h"
#include "gpu/shadow_planes/silhouettes.h"
#include "scene/camera.h"

namespace airlight::gpu {

class FanOnDevice {
 public:
  explicit FanOnDevice(Context&);

  // Sorts a light's edges for all rays of a camera. An edge is in four lists at most: there is always room.
  void fill(const scene::Camera&, const Point3& light, const LightEdges&);

  // Binds 3 (where lists begin), 4 (the edges' places), sets the uniforms of fan.glsl.
  void bind(LinkedProgram&) const;

 private:
  Context& context_;
  Buffer counts_, starts_;
  std::unique_ptr<Buffer> lists_;
  Vec3 x_, y_;
};

}  // namespace airlight::gpu
