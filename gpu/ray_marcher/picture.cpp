#include "gpu/ray_marcher/picture.h"

#include <algorithm>
#include <limits>

#include "gpu/ray_marcher/interface.h"
#include "gpu/view_uniforms.h"

namespace airlight::gpu::ray_marcher {
namespace {

constexpr std::size_t band_bytes = std::size_t(64) << 20;  // of the pixels' state that is on the device at once
constexpr std::size_t pixel_bytes = 64;                    // the layout of pixel.glsl

}  // namespace

Picture::Picture(Context& context, const scene::Scene& scene, const MediaOnDevice& media, const Columns& columns,
                 int lights, const airlight::ray_marcher::Options& options, const FirstHits* first_hits)
    : Picture(context, scene, media, columns, lights, options, first_hits, MaterialTables(scene)) {}

Picture::Picture(Context& context, const scene::Scene& scene, const MediaOnDevice& media, const Columns& columns,
                 int lights, const airlight::ray_marcher::Options& options, const FirstHits* first_hits,
                 const MaterialTables& tables)
    : media_(media),
      columns_(columns),
      lights_(lights),
      options_(options),
      first_hits_(first_hits),
      materials_(context, "materials", tables.materials),
      reflectances_(context, "tables of reflectances", tables.values),
      environments_(context, scene),
      rounds_(context, "surfaces") {
  const std::string side = std::to_string(Rounds::tile);
  auto definitions = media.definitions();
  definitions.insert({{"LOCAL_SIZE_X", side}, {"LOCAL_SIZE_Y", side}});
  if (scene.geometry && lights > 0) {
    auto reflecting = definitions;
    reflecting.merge(columns.definitions());
    // Columns alone ask for densities.
    if (columns.depths() == Columns::Depths::none || columns.depths() == Columns::Depths::maps)
      for (const char* field : {"GRIDS", "TEXTURES", "GAUSSIANS"}) reflecting[field] = "0";
    surfaces_ = &program(context, "ray_marcher/surfaces.comp", reflecting);
    if (const Box box = scene.geometry->bounds(); !box.empty())
      magnitude_ = std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
    for (const scene::Surface& surface : scene.surfaces)
      if (const auto* plane = std::get_if<scene::Plane>(&surface.shape))
        magnitude_ = std::max(magnitude_, plane->point.cwiseAbs().maxCoeff());
  }
  for (int i = 0; i < environments_.count(); ++i) {
    auto background = environments_.definitions(i);
    background.insert({{"LOCAL_SIZE_X", side}, {"LOCAL_SIZE_Y", side}, {"LAYERS", definitions.at("LAYERS")}});
    backgrounds_.push_back(&program(context, "ray_marcher/background.comp", background));
  }
  composition_ = &program(context, "ray_marcher/composition.comp", {{"LOCAL_SIZE_X", "64"}});
}

void Picture::reflect(const scene::View& view, const FilmOnDevice& film, FrameBuffers& buffers, const Band& band) {
  Program& p = *surfaces_;
  media_.bind(p);
  columns_.bind(p, options_);
  film.primitives->bind(at::primitives);
  band.pixels.bind(at::pixels);
  film.surface.bind(at::surface);
  materials_.bind(at::materials);
  reflectances_.bind(at::reflectances);
  first_hits_->surfaces().bind();
  first_hits_->tree().bind(p);
  p.set("triangle_count", first_hits_->surfaces().triangles());
  p.set("light_count", lights_);
  p.set_double("middle", media_.middle());
  // Offset of Geometry::offset_origin.
  const double reach = std::max(magnitude_, view.camera.position.cwiseAbs().maxCoeff());
  p.set_double("nudge", 32 * std::numeric_limits<double>::epsilon() * reach);
  set_view(p, view);
  const int columns = (view.width + Rounds::tile - 1) / Rounds::tile;
  p.set("tile_columns", columns);
  p.set("first_row", band.first_row);
  rounds_.run(p, buffers, columns * ((band.rows + Rounds::tile - 1) / Rounds::tile));
}

void Picture::add_environments(const scene::View& view, const FilmOnDevice& film, const Band& band) {
  for (int i = 0; i < environments_.count(); ++i) {
    Program& p = *backgrounds_[i];
    if (film.primitives) film.primitives->bind(at::primitives);
    band.pixels.bind(at::pixels);
    film.surface.bind(at::surface);
    environments_.bind(i, p);
    set_camera(p, view, media_.middle());
    p.set("rows", band.rows);
    p.set("first_row", band.first_row);
    p.set("has_primitives", film.primitives != nullptr);
    p.set("has_surface", surfaces_ || i > 0);
    p.dispatch(view.width, band.rows);
  }
}

void Picture::compose(const scene::View& view, const FilmOnDevice& film, const Band& band, bool has_media,
                      const Buffer* totals) {
  Program& p = *composition_;
  film.airlight.bind(at::airlight_layer);
  film.transmittance.bind(at::transmittance_layer);
  film.mean.bind(at::mean_layer);
  band.pixels.bind(at::pixels);
  film.surface.bind(at::surface);
  if (totals) totals->bind(at::totals);
  if (film.seen) film.seen->bind(at::seen);
  p.set("has_seen", film.seen != nullptr);
  p.set("pixel_count", view.width * band.rows);
  p.set("first_pixel", view.width * band.first_row);
  p.set("has_media", has_media);
  p.set("has_surface", surfaces_ || environments_.count() > 0);
  p.set("counts", totals && (has_media || surfaces_));
  p.dispatch(view.width * band.rows);
}

void Picture::render(const scene::View& view, const FilmOnDevice& film, Frame& frame,
                     const std::function<void(const Band&)>& fill, const Buffer* totals, bool looks,
                     const std::function<bool(double)>& progress) {
  rounds_.begin(looks, progress);
  const std::size_t row_bytes = std::size_t(view.width) * pixel_bytes;
  const int most_rows = std::max<int>(1, int(band_bytes / row_bytes) / Rounds::tile) * Rounds::tile;
  for (int row = 0; row < view.height; row += most_rows) {
    const int rows = std::min(most_rows, view.height - row);
    const Band band{row, rows, frame.buffers.get("pixels", row_bytes * std::size_t(std::min(most_rows, view.height)))};
    if (fill) fill(band);
    if (surfaces_ || environments_.count() > 0) {
      frame.timer.begin("surfaces");
      if (surfaces_) reflect(view, film, frame.buffers, band);
      add_environments(view, film, band);
    }
    frame.timer.begin("composition");
    compose(view, film, band, bool(fill), totals);
  }
}

}  // namespace airlight::gpu::ray_marcher
