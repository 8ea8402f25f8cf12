// The meshes of a scene by their edges on the device, and which of them bound a light's shadows: Biri et al. 2006,
// section 5.1, stage 1.
#pragma once
#include <memory>

#include "gpu/buffer.h"
#include "methods/shadow_planes/surface_count.h"

namespace airlight::gpu {

// Of one light. The layout of edge.glsl, in no particular order.
struct LightEdges {
  std::unique_ptr<Buffer> edges;
  int count = 0;
};

class Silhouettes {
 public:
  // Uploads the edges of all meshes. Throws Error where they pass the device's limits.
  Silhouettes(Context&, const shadow_planes::Occluders&);

  // Finds those of a light, on the device; waits for their number.
  void find(const Point3& light, LightEdges&);

 private:
  struct Arrays;
  static Arrays arrays(const shadow_planes::Occluders&);
  Silhouettes(Context&, const Arrays&);

  Context& context_;
  int mesh_edges_;
  Buffer vertices_, triangles_, edges_, sides_, count_;
};

}  // namespace airlight::gpu
