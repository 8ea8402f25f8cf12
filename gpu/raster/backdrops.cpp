#include "gpu/raster/backdrops.h"

#include <cmath>

#include "gpu/view_uniforms.h"

namespace airlight::gpu {

Backdrops::Picture::Picture(Context& context, const scene::Backdrop& backdrop)
    : width(backdrop.width),
      height(backdrop.height),
      fills(backdrop.fills),
      depth(context, "depths of a backdrop", backdrop.depth),
      radiance(context, "radiance of a backdrop", backdrop.radiance) {}

Backdrops::Backdrops(Context& context, const scene::Scene& scene)
    : scene_(scene),
      program_(context.program("raster/backdrop.comp", {{"LOCAL_SIZE_X", std::to_string(pixel_tile)},
                                                        {"LOCAL_SIZE_Y", std::to_string(pixel_tile)}})) {
  const Use use(context);
  for (const auto& backdrop : scene.backdrops) pictures_.push_back(std::make_unique<Picture>(context, *backdrop));
}

void Backdrops::find(const scene::View& view, const Buffer& distances, bool known, const Buffer& seen,
                     const Buffer* primitives) const {
  find(view, distances, known, &seen, primitives, {view.width, view.height, 1, 1, 0.5, 0.5});
}

void Backdrops::find(const scene::View& view, const Buffer& distances, bool known, const CellGrid& grid) const {
  find(view, distances, known, nullptr, nullptr, grid);
}

void Backdrops::find(const scene::View& view, const Buffer& distances, bool known, const Buffer* seen,
                     const Buffer* primitives, const CellGrid& grid) const {
  require_own_camera(scene_, view);
  set_camera(program_, view);
  distances.bind(0);
  (seen ? *seen : distances).bind(1);
  (primitives ? *primitives : distances).bind(4);
  program_.set("columns", grid.columns);
  program_.set("rows", grid.rows);
  program_.set("first_ray", int(grid.first));
  program_.set("keeps_seen", seen != nullptr);
  program_.set("has_primitives", primitives != nullptr);
  program_.set("cut", grid.cut);
  program_.set_double("cell_width", grid.width);
  program_.set_double("cell_height", grid.height);
  program_.set_double("cell_x", grid.x);
  program_.set_double("cell_y", grid.y);
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const Picture& picture = *pictures_[i];
    program_.set("first", i == 0);
    program_.set("has_distances", known || i > 0);
    program_.set("picture_width", picture.width);
    program_.set("picture_height", picture.height);
    program_.set("fills", picture.fills);
    picture.depth.bind(2);
    picture.radiance.bind(3);
    program_.dispatch(grid.columns, grid.rows);
  }
}

}  // namespace airlight::gpu
