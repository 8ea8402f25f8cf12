// The meshes of a scene by their edges on the device, and which of them bound a light's shadows: Biri et al. 2006,
// section 5.1, stage 1.
#pragma once
#include <memory>

#include "gpu/shadow_planes/interface.h"
#include "methods/shadow_planes/surface_count.h"

namespace airlight::gpu::shadow_planes {

// Silhouette edges of one light. Only the device knows their number.
struct LightEdges {
  std::unique_ptr<Buffer> edges;  // the layout of edge.glsl, in no particular order
  std::unique_ptr<Buffer> state;  // the layout of light_state.glsl

  void bind() const {
    edges->bind(at::edges);
    state->bind(at::light_state);
    state->bind_as(GL_UNIFORM_BUFFER, at::light_state);
  }
  // An invocation per edge, rows of them with `planes`; of programs whose groups are edges_per_group edges.
  void dispatch(Program& program, bool planes = false) const {
    program.dispatch_indirect(*state,
                              planes ? offsetof(LightStateData, plane_groups) : offsetof(LightStateData, edge_groups));
  }
};

class Silhouettes {
 public:
  // Uploads the edges of all meshes. `plane_rows`: vertices of a plane, for LightEdges::dispatch. Throws
  // Unavailable where they pass the device's limits.
  Silhouettes(Context&, const airlight::shadow_planes::Occluders&, int plane_rows);

  // Finds those of a light, on the device.
  void find(const Point3& light, LightEdges&) const;
  int most() const { return mesh_edges_; }  // that a light can have

  // Binds the meshes: edge_meshes.glsl, and by the scene's triangles their places there.
  void bind_meshes() const;

 private:
  struct Arrays;
  static Arrays arrays(const airlight::shadow_planes::Occluders&);
  Silhouettes(Context&, const Arrays&, int plane_rows);

  Context& context_;
  int mesh_edges_, plane_rows_;
  Buffer vertices_, triangles_, numbers_, edges_, sides_;
  Program& program_;
};

}  // namespace airlight::gpu::shadow_planes
