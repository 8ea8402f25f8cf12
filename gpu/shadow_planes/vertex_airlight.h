// The paper's Gamma at the vertices of meshes, of a medium's boundary and of shadow planes (vertices.comp), of one
// light and one air seen from one place.
#pragma once
#include <map>
#include <memory>

#include "gpu/frame.h"
#include "gpu/raster/surfaces_on_device.h"
#include "gpu/shadow_planes/airlight_term.h"
#include "gpu/shadow_planes/silhouette.h"

namespace airlight::gpu::shadow_planes {

class VertexValues {
 public:
  // All arguments must outlive this object. `surfaces` is null if there are none. Planes are meshed for `most_edges`
  // silhouette edges, or for as many as a storage block has room for; the frame's counters tell if there were more.
  // Throws Unavailable if there is no room for the vertices of surfaces.
  VertexValues(Context&, const std::shared_ptr<const scene::Scene>&, const airlight::shadow_planes::Options&,
               const AirlightTermsOnDevice&, const SurfacesOnDevice* surfaces, int most_edges);

  // Vertices of a plane.
  static int plane_rows(const airlight::shadow_planes::Options& options) {
    return (options.edge_split + 1) * (options.plane_levels + 2);
  }

  // `far`: how far from the light planes are meshed [m]. `edges` is null where there are none. Loops that the driver
  // ends are told in `counters` (counters.glsl).
  void fill(Frame&, int light, int term, const Point3& camera, const LightEdges* edges, double far,
            const Buffer& counters);

  // Binds the values, sets the uniforms of stencil.glsl.
  void bind(LinkedProgram&) const;
  long count(int term) const;  // without those of planes

 private:
  enum class Of { meshes, boundary, planes };
  Program& prepare(Of, int light, int term, const Point3& camera);

  Context& context_;
  const std::shared_ptr<const scene::Scene>& scene_;
  airlight::shadow_planes::Options options_;
  const AirlightTermsOnDevice& airlight_terms_;
  const SurfacesOnDevice* surfaces_;
  int most_edges_;
  std::map<std::array<int, 3>, Program*> programs_;  // by what of, kind of light, term
  const Buffer* values_ = nullptr;
  int meshes_ = 0, of_term_ = 0;  // vertices: of surfaces, of all but planes
  double far_ = 0;
};

}  // namespace airlight::gpu::shadow_planes
