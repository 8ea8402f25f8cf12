#include "gpu/shadow_planes/vertex_airlight.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/error.h"

namespace airlight::gpu::shadow_planes {

using airlight::shadow_planes::Options;

VertexValues::VertexValues(Context& context, const std::shared_ptr<const scene::Scene>& scene, const Options& options,
                           const AirlightTermsOnDevice& airlight_terms, const SurfacesOnDevice* surfaces,
                           int most_edges)
    : context_(context),
      scene_(scene),
      options_(options),
      airlight_terms_(airlight_terms),
      surfaces_(surfaces),
      meshes_(surfaces ? surfaces->vertices() : 0) {
  const long room = long(context.limits().storage_block / 16) - meshes_ -
                    6L * (options.boundary_cells + 1) * (options.boundary_cells + 1);
  if (room < 0)
    throw Unavailable(fmt::format("gpu: values at {} vertices of surfaces pass the {} bytes of a storage block of {}",
                                  meshes_, context.limits().storage_block, context.renderer()));
  most_edges_ = int(std::min<long>(most_edges, room / plane_rows(options)));
}

Program& VertexValues::prepare(Of of, int light, int term, const Point3& camera) {
  const scene::Light& shines = scene_->lights[light];
  const auto* spot = std::get_if<scene::SpotLight>(&shines);
  Program*& p = programs_[{int(of), spot != nullptr, term}];
  if (!p) {
    auto definitions = airlight_terms_.definitions(light, term);
    definitions["OF"] = std::to_string(int(of));
    p = &program(context_, "vertices", edges_per_group, 1, definitions);
  }
  airlight_terms_.bind(*p, light, term);
  p->set("loop_count", 3);
  p->set_double("camera", camera);
  p->set_double("ball_radius", scene::ball(shines)->radius);
  p->set("intensity", spot ? spot->intensity : std::get<scene::PointLight>(shines).intensity);
  return *p;
}

long VertexValues::count(int term) const {
  const int side = options_.boundary_cells + 1;
  return meshes_ + (airlight_terms_.region(term) ? 6L * side * side : 0);
}

void VertexValues::fill(Frame& frame, int light, int term, const Point3& camera, const LightEdges* edges, double far,
                        const Buffer& counters) {
  const Use use(context_);
  const int cells = options_.boundary_cells, rows = plane_rows(options_);
  far_ = far;
  of_term_ = int(count(term));
  values_ = &frame.buffers.get("values at vertices",
                               16 * (std::size_t(of_term_) + (edges ? std::size_t(most_edges_) * rows : 0)));
  values_->bind(at::values);
  counters.bind(at::counters);
  if (surfaces_) surfaces_->bind();
  const auto evaluate = [&](Of of, int first, int vertices) {
    if (vertices == 0) return;
    frame.timer.begin("vertices of surfaces");
    Program& p = prepare(of, light, term, camera);
    p.set("vertex_count", vertices);
    p.set("first_value", first);
    if (of == Of::boundary) p.set("boundary_cells", cells);
    p.dispatch(vertices);
  };
  evaluate(Of::meshes, 0, meshes_);
  evaluate(Of::boundary, meshes_, of_term_ - meshes_);
  if (!edges) return;
  frame.timer.begin("vertices of planes");
  Program& p = prepare(Of::planes, light, term, camera);
  p.set("first_value", of_term_);
  p.set("pieces", options_.edge_split);
  p.set("most_edges", most_edges_);
  p.set("plane_levels", options_.plane_levels);
  p.set("plane_far", far);
  edges->bind();
  edges->dispatch(p, true);
}

void VertexValues::bind(LinkedProgram& program) const {
  values_->bind(at::values);
  program.set("first_boundary", meshes_);
  program.set("first_plane", of_term_);
  program.set("plane_levels", options_.plane_levels);
  program.set("plane_far", far_);
}

}  // namespace airlight::gpu::shadow_planes
