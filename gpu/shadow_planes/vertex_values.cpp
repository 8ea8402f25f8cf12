#include "gpu/shadow_planes/vertex_values.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/program.h"
#include "scene/error.h"

namespace airlight::gpu {

void VertexValues::fill(Context& context, const scene::Scene& scene, const shadow_planes::Options& options,
                        const AirlightTermsOnDevice& airlight_terms, int light, int term, const Point3& camera,
                        const SurfacesOnDevice* surfaces, const LightEdges* edges, double far, const Buffer& counters,
                        StageTimer& timer) {
  const Use use(context);
  const scene::Light& of = scene.lights[light];
  const auto* spot = std::get_if<scene::SpotLight>(&of);
  levels_ = options.plane_levels;
  cells_ = options.boundary_cells;
  far_ = far;
  meshes_ = surfaces ? surfaces->vertices() : 0;
  boundary_ = airlight_terms.region(term) ? 6 * (cells_ + 1) * (cells_ + 1) : 0;
  const double of_planes = edges ? double(edges->count) * (options.edge_split + 1) * (levels_ + 2) : 0;
  const std::size_t most = context.limits().storage_block;
  if ((of_planes + meshes_ + boundary_) * 16 > double(most))
    throw Unavailable(fmt::format("gpu: values at {:.0f} vertices pass the {} bytes of a storage block of {}",
                                  of_planes + meshes_ + boundary_, most, context.renderer()));
  planes_ = int(of_planes);
  const std::size_t bytes = 16 * std::size_t(count());
  if (!values_ || values_->bytes() < bytes) values_ = std::make_unique<Buffer>(context, "values at vertices", bytes);
  int first = 0;
  const auto evaluate = [&](int kind, int count, const char* stage) {
    if (count == 0) return;
    auto definitions = airlight_terms.definitions(light, term);
    definitions.insert({{"LOCAL_SIZE_X", "64"}, {"OF", std::to_string(kind)}});
    Program& p = context.program("shadow_planes/vertices.comp", definitions);
    if (surfaces) surfaces->bind();
    if (edges) edges->edges->bind(0);
    airlight_terms.bind(p, light, term);
    values_->bind(13);
    counters.bind(14);
    p.set("loop_count", 3);
    p.set("vertex_count", count);
    p.set("first_value", first);
    p.set("pieces", options.edge_split);
    p.set_double("camera", camera);
    p.set_double("ball_radius", scene::ball(of)->radius);
    p.set("intensity", spot ? spot->intensity : std::get<scene::PointLight>(of).intensity);
    if (kind == 1) p.set("boundary_cells", cells_);
    if (kind == 2) {
      p.set("plane_levels", levels_);
      p.set("plane_far", far);
    }
    p.dispatch(count);
    first += count;
    timer.stage(stage);
  };
  evaluate(0, meshes_, "vertices of surfaces");
  evaluate(1, boundary_, "vertices of surfaces");
  evaluate(2, planes_, "vertices of planes");
}

void VertexValues::bind(LinkedProgram& program) const {
  values_->bind(13);
  program.set("first_boundary", meshes_);
  program.set("first_plane", meshes_ + boundary_);
  program.set("plane_levels", levels_);
  program.set("plane_far", far_);
}

}  // namespace airlight::gpu
