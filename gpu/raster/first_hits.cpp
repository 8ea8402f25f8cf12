#include "gpu/raster/first_hits.h"

#include <fmt/format.h>

#include "gpu/view_uniforms.h"
#include "scene/base/error.h"

namespace airlight::gpu {
namespace {

// llvmpipe ends loops after 65535 iterations (gpu/README.md): 28 at most from leaf to leaf, those over 16 nodes and twice
// four triangles among them; the rest is for solids.
constexpr int leaves_at_once = 2150, most_solids = 5000;
// A ray is at a node once at most, and after 16 nodes it has met a leaf or not.
constexpr int most_leaves(int nodes) { return (nodes + 1) / 2 + nodes / 16 + 1; }

void require_room(const Buffer& distances, const Buffer* primitives, int columns, int rows, std::size_t first) {
  const std::size_t rays = std::size_t(columns) * rows, bytes = (first + rays) * 4;
  if (bytes > distances.bytes() || (primitives && bytes > primitives->bytes()))
    throw Error(fmt::format("gpu: {} rays from place {} do not fit into {} bytes", rays, first, distances.bytes()));
}

}  // namespace

void FirstHits::bind(scene::SettingBinder& b, Way& way) {
  b.choice("first_hits", way, {{"tree", Way::tree}, {"raster", Way::raster}},
           "what ends camera rays; raster: by the rasteriser, faster on some devices, "
           "to 1/256 pixel at silhouettes");
}

FirstHits::FirstHits(Context& context, const scene::Scene& scene, bool with_balls, Way way)
    : context_(context), surfaces_(context, scene, with_balls), tree_(context, scene) {
  if (way == Way::raster)
    raster_ = std::make_unique<RasterPass>(context);
  else
    require_program();
}

void FirstHits::require_program() const {
  if (program_) return;
  if (context_.software()) {
    if (surfaces_.solids().size() > most_solids)
      throw Unavailable(fmt::format("gpu: {} spheres and planes, {} takes {} at most", surfaces_.solids().size(),
                                    context_.renderer(), most_solids));
    dispatches_ = std::max(1, (most_leaves(tree_.nodes()) + leaves_at_once - 1) / leaves_at_once);
  }
  program_ = &context_.program("raster/first_hits.comp", {{"LOCAL_SIZE_X", std::to_string(pixel_tile)},
                                                          {"LOCAL_SIZE_Y", std::to_string(pixel_tile)},
                                                          {"RESUMES", dispatches_ > 1 ? "1" : "0"}});
}

void FirstHits::find(const scene::View& view, const Buffer& distances, const Buffer* primitives,
                     const HitGrid& grid) const {
  const int columns = grid.columns(view), rows = grid.rows(view);
  if (!raster_) {
    const double side = grid.block;
    trace(view, distances, primitives, {columns, rows, side, side, 0.5, 0.5, grid.first});
    return;
  }
  require_room(distances, primitives, columns, rows, grid.first);
  const Use use(context_);
  raster_->find(surfaces_, view, distances, primitives, grid);
}

void FirstHits::find(const scene::View& view, const Buffer& distances, const CellGrid& grid) const {
  require_program();
  trace(view, distances, nullptr, grid);
}

void FirstHits::trace(const scene::View& view, const Buffer& distances, const Buffer* primitives,
                      const CellGrid& grid) const {
  const int columns = grid.columns, rows = grid.rows;
  require_room(distances, primitives, columns, rows, grid.first);
  const Use use(context_);
  Program& program = *program_;
  set_view(program, view);
  program.set("columns", columns);
  program.set("rows", rows);
  program.set("cut", grid.cut);
  program.set_double("cell_width", grid.width);
  program.set_double("cell_height", grid.height);
  program.set_double("cell_x", grid.x);
  program.set_double("cell_y", grid.y);
  program.set("first_ray", int(grid.first));
  program.set("triangle_count", surfaces_.triangles());
  program.set("ball_count", int(surfaces_.solids().size()) - tree_.solids());
  program.set("keeps_primitives", primitives != nullptr);
  surfaces_.bind();
  tree_.bind(program);
  distances.bind(0);
  (primitives ? *primitives : distances).bind(1);
  if (dispatches_ == 1) {
    program.dispatch(columns, rows);
    return;
  }
  // Groups of the dispatches, which each finds for the next; then where every ray is.
  const std::size_t bytes = 4 * (3 * std::size_t(dispatches_) + 2 * std::size_t(columns) * rows);
  if (!unfinished_ || unfinished_->bytes() < bytes)
    unfinished_ = std::make_unique<Buffer>(context_, "unfinished rays", bytes, Contents::undefined);
  unfinished_->clear();
  unfinished_->bind(2);
  program.set("dispatches", dispatches_);
  program.set("leaves_at_once", leaves_at_once);
  for (int i = 0; i < dispatches_; ++i) {
    program.set("dispatch", i);
    if (i == 0)
      program.dispatch(columns, rows);
    else
      program.dispatch_indirect(*unfinished_, 12 * std::size_t(i));
  }
}

}  // namespace airlight::gpu
