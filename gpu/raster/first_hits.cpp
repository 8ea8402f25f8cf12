#include "gpu/raster/first_hits.h"

#include <fmt/format.h>

#include "gpu/program.h"
#include "gpu/view_uniforms.h"
#include "scene/error.h"

namespace airlight::gpu {

FirstHits::FirstHits(Context& context, const scene::Scene& scene, bool with_balls)
    : context_(context), surfaces_(context, scene, with_balls), tree_(context, scene) {}

void FirstHits::find(const scene::View& view, const Buffer& distances, const Buffer* primitives,
                     const HitGrid& grid) const {
  const int columns = grid.columns(view), rows = grid.rows(view);
  const std::size_t bytes = (grid.first + std::size_t(columns) * rows) * 4;
  if (bytes > distances.bytes() || (primitives && bytes > primitives->bytes()))
    throw Error(fmt::format("gpu: {} x {} rays do not fit into {} bytes", columns, rows, distances.bytes()));
  const Use use(context_);
  Program& program = context_.program("raster/first_hits.comp", {{"LOCAL_SIZE_X", "8"},
                                                                 {"LOCAL_SIZE_Y", "8"},
                                                                 {"PRIMITIVES", primitives ? "1" : "0"}});
  set_view(program, view);
  program.set("columns", columns);
  program.set("rows", rows);
  program.set("block", grid.block);
  program.set("first_ray", int(grid.first));
  program.set("triangle_count", surfaces_.triangles());
  surfaces_.bind();
  tree_.bind(program);
  program.set("ball_count", int(surfaces_.solids().size()) - tree_.solids());
  distances.bind(0);
  if (primitives) primitives->bind(1);
  program.dispatch(columns, rows);
}

}  // namespace airlight::gpu
