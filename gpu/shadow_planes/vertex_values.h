// The paper's Gamma at the vertices of meshes, of a medium's boundary and of shadow planes (vertices.comp), of one
// light and one air seen from one place.
#pragma once
#include <memory>

#include "gpu/raster/surfaces_on_device.h"
#include "gpu/shadow_planes/airlight_terms_on_device.h"
#include "gpu/shadow_planes/silhouettes.h"
#include "gpu/timer.h"

namespace airlight::gpu {

class VertexValues {
 public:
  // `far`: how far from the light planes are meshed [m]. `surfaces` and `edges` are null where there are none. Loops
  // that the driver ends are told in `counters` (shading.h).
  void fill(Context&, const scene::Scene&, const shadow_planes::Options&, const AirlightTermsOnDevice&, int light,
            int term, const Point3& camera, const SurfacesOnDevice* surfaces, const LightEdges* edges, double far,
            const Buffer& counters, StageTimer&);

  // Binds 13, sets the uniforms of stencil.glsl.
  void bind(LinkedProgram&) const;
  long count() const { return boundary_ + planes_ + meshes_; }

 private:
  std::unique_ptr<Buffer> values_;
  int meshes_ = 0, boundary_ = 0, planes_ = 0;  // vertices
  int levels_ = 0, cells_ = 0;
  double far_ = 0;
};

}  // namespace airlight::gpu
