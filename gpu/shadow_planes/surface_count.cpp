#include "gpu/shadow_planes/surface_count.h"

#include "gpu/view_uniforms.h"

namespace airlight::gpu::shadow_planes {

OriginCounts::OriginCounts(Context& context, const Silhouettes& silhouettes, const FirstHits& surfaces)
    : context_(context), silhouettes_(silhouettes), surfaces_(surfaces) {}

void OriginCounts::find(const scene::View& view, const Point3& light, const LightEdges& edges, const Buffer& states,
                        const Buffer& counters) const {
  const Use use(context_);
  const bool by_pixel = view.camera.kind != scene::Camera::Kind::perspective;
  Program*& p = programs_[by_pixel];
  if (!p) p = &program(context_, "counts", by_pixel ? 8 : 128, by_pixel ? 8 : 1, {{"BY_PIXEL", by_pixel ? "1" : "0"}});
  silhouettes_.bind_meshes();
  surfaces_.surfaces().bind();
  surfaces_.tree().bind(*p);
  edges.bind();
  states.bind(at::states);
  counters.bind(at::counters);
  set_view(*p, view);
  p->set_double("light", light);
  p->set("loop_count", 3);
  p->dispatch(by_pixel ? view.width : 1, by_pixel ? view.height : 1);
}

}  // namespace airlight::gpu::shadow_planes
