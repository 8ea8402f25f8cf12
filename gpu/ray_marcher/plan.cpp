#include "gpu/ray_marcher/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "gpu/view_uniforms.h"
#include "scene/base/error.h"

namespace airlight::gpu::ray_marcher {
namespace {

constexpr std::size_t band_bytes = std::size_t(64) << 20;  // of the pixels' state that is on the device at once
constexpr std::size_t pixel_bytes = 64;                    // the layout of pixel.glsl
constexpr double software_most = 65535;

template <class Has>
bool any_layer(const airlight::ray_marcher::Plan& plan, Has has) {
  return std::any_of(plan.layers.begin(), plan.layers.end(), has);
}

// Iterations of loops between two places where a march may stop and go on later: one light at one step.
double iterations_at_once(const airlight::ray_marcher::Plan& plan) {
  const airlight::ray_marcher::Options& o = plan.options;
  const bool exact = o.shadow == airlight::ray_marcher::Shadow::exact;
  double sum = 0;
  for (const airlight::ray_marcher::Layer& layer : plan.layers) {
    if (!layer.varies) continue;
    const double across = bounding_box(layer.varied).size().norm(), most = double(1 << 20);
    const double steps = o.shadow_step > 0 ? std::min(across / o.shadow_step, most) : o.shadow_steps;
    // Divided steps (deep_column): 20 / deepest of them on the way into the dark, twice for the halves, and the way
    // back up.
    if (!exact && layer.most_varied * layer.thickest * across / steps > deepest_shadow_step(o))
      sum += 4 * 20 / deepest_shadow_step(o) * (layer.gaussians ? 3 * double(layer.gaussians->count) : 1);
    if (!layer.gaussians)
      sum += steps;
    else if (layer.gaussians->any_negative)
      sum += steps * double(layer.gaussians->count);
    else
      sum += double(layer.gaussians->count) * (exact ? 1 : 1 + steps / 4);
  }
  return sum;
}

}  // namespace

PlanOnDevice::PlanOnDevice(Context& context, const airlight::ray_marcher::Plan& plan, GridStorage storage,
                           const FirstHits* first_hits)
    : PlanOnDevice(context, plan, storage, first_hits, MaterialTables(*plan.scene)) {}

PlanOnDevice::PlanOnDevice(Context& context, const airlight::ray_marcher::Plan& plan, GridStorage storage,
                           const FirstHits* first_hits, const MaterialTables& tables)
    : context_(context),
      plan_(plan),
      first_hits_(first_hits),
      middle_(middle_of(plan)),
      balls_(int(std::count_if(plan.lights.begin(), plan.lights.end(), [](const auto& l) { return bool(ball(l)); }))),
      has_occluders_(plan.scene->geometry && plan.scatters),
      reflects_(plan.scene->geometry && !plan.lights.empty()),
      grids_(context, plan, storage),
      layers_(context, "layers", layer_data(plan, middle_, grids_.textures() > 0)),
      gaussians_(context, "Gaussians", gaussian_data(plan)),
      bricks_(context, "maps of empty space", brick_data(plan)),
      lights_(context, "lights", light_data(plan, middle_)),
      solids_(context, "spheres and planes", solid_data(plan, middle_)),
      materials_(context, "materials", tables.materials),
      reflectances_(context, "tables of reflectances", tables.values),
      environments_(context, *plan.scene),
      march_rounds_(context, "march"),
      surface_rounds_(context, "surfaces") {
  if (context.software() && iterations_at_once(plan) > software_most)
    throw Unavailable(
        fmt::format("gpu: a shadow ray may take {:.0f} iterations, {} stops after {:.0f}; expected fewer shadow steps",
                    iterations_at_once(plan), context.renderer(), software_most));
  const std::string side = std::to_string(Rounds::tile);
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const std::map<std::string, std::string> media{
      {"LOCAL_SIZE_X", side},
      {"LOCAL_SIZE_Y", side},
      {"LAYERS", std::to_string(plan.layers.size())},
      {"GRIDS", flag(any_layer(plan, [](const auto& l) { return bool(l.grid); }))},
      {"TEXTURES", std::to_string(grids_.textures())},
      {"GAUSSIANS", flag(any_layer(plan, [](const auto& l) { return bool(l.gaussians); }))}};
  auto marching = media;
  marching.insert({{"OCCLUDERS", flag(has_occluders_)}, {"BALL_WORDS", std::to_string(balls_ / 32 + 1)}});
  if (!plan.layers.empty()) march_ = &program(context, "ray_marcher/march.comp", marching);
  if (reflects_) {
    surfaces_ = &program(context, "ray_marcher/surfaces.comp", media);
    if (const Box box = plan.scene->geometry->bounds(); !box.empty())
      magnitude_ = std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
    for (const scene::Surface& surface : plan.scene->surfaces)
      if (const auto* plane = std::get_if<scene::Plane>(&surface.shape))
        magnitude_ = std::max(magnitude_, plane->point.cwiseAbs().maxCoeff());
  }
  for (int i = 0; i < environments_.count(); ++i) {
    auto definitions = environments_.definitions(i);
    definitions.insert({{"LOCAL_SIZE_X", side}, {"LOCAL_SIZE_Y", side}, {"LAYERS", media.at("LAYERS")}});
    backgrounds_.push_back(&program(context, "ray_marcher/background.comp", definitions));
  }
  composition_ = &program(context, "ray_marcher/composition.comp", {{"LOCAL_SIZE_X", "64"}});
}

// What marching and reflecting have in common.
void PlanOnDevice::bind(Program& p) const {
  const airlight::ray_marcher::Options& o = plan_.options;
  layers_.bind_as(GL_UNIFORM_BUFFER, at::layers);
  gaussians_.bind(at::gaussians);
  grids_.bind();
  bricks_.bind(at::free_distances);
  lights_.bind(at::lights);
  p.set("layer_count", int(plan_.layers.size()));
  p.set("skip_empty", o.skip_empty);
  p.set("exact_shadow", o.shadow == airlight::ray_marcher::Shadow::exact);
  p.set("shadow_steps", o.shadow_steps);
  p.set("shadow_step", o.shadow_step);
  p.set("deepest_shadow_step", deepest_shadow_step(o));
}

void PlanOnDevice::march(const scene::View& view, const MarchedFilm& film, FrameBuffers& buffers, const Band& band) {
  const airlight::ray_marcher::Options& o = plan_.options;
  Program& p = *march_;
  bind(p);
  if (film.distances) film.distances->bind(at::distances);
  band.pixels.bind(at::pixels);
  if (has_occluders_) {
    first_hits_->tree().bind(p);
    solids_.bind(at::solids);
    p.set("middle_in_tree", Vec3(middle_ - first_hits_->tree().middle()));
  }
  p.set("light_count", plan_.scatters ? int(plan_.lights.size()) : 0);
  p.set("balls", plan_.scatters ? balls_ : 0);
  p.set("graded", o.graded);
  p.set("steps", o.steps);
  p.set("step_length", o.step);
  p.set("horizon", o.horizon);
  p.set("deepest_step", deepest_step(o));
  p.set("darkest", o.early_exit > 0 ? float(-std::log(o.early_exit)) : far_away);
  set_camera(p, view, middle_);
  const int columns = (view.width + Rounds::tile - 1) / Rounds::tile;
  p.set("tile_columns", columns);
  p.set("first_row", band.first_row);
  p.set("has_distances", film.distances != nullptr);
  march_rounds_.run(p, buffers, columns * ((band.rows + Rounds::tile - 1) / Rounds::tile));
}

void PlanOnDevice::reflect(const scene::View& view, const MarchedFilm& film, FrameBuffers& buffers, const Band& band) {
  Program& p = *surfaces_;
  bind(p);
  film.primitives->bind(at::primitives);
  band.pixels.bind(at::pixels);
  film.surface.bind(at::surface);
  materials_.bind(at::materials);
  reflectances_.bind(at::reflectances);
  first_hits_->surfaces().bind();
  first_hits_->tree().bind(p);
  p.set("triangle_count", first_hits_->surfaces().triangles());
  p.set("light_count", int(plan_.lights.size()));
  p.set_double("middle", middle_);
  // As Geometry::offset_origin.
  const double reach = std::max(magnitude_, view.camera.position.cwiseAbs().maxCoeff());
  p.set_double("nudge", 32 * std::numeric_limits<double>::epsilon() * reach);
  set_view(p, view);
  const int columns = (view.width + Rounds::tile - 1) / Rounds::tile;
  p.set("tile_columns", columns);
  p.set("first_row", band.first_row);
  surface_rounds_.run(p, buffers, columns * ((band.rows + Rounds::tile - 1) / Rounds::tile));
}

void PlanOnDevice::add_environments(const scene::View& view, const MarchedFilm& film, const Band& band) {
  for (int i = 0; i < environments_.count(); ++i) {
    Program& p = *backgrounds_[i];
    if (film.primitives) film.primitives->bind(at::primitives);
    band.pixels.bind(at::pixels);
    film.surface.bind(at::surface);
    environments_.bind(i, p);
    set_camera(p, view, middle_);
    p.set("rows", band.rows);
    p.set("first_row", band.first_row);
    p.set("has_primitives", film.primitives != nullptr);
    p.set("has_surface", reflects_ || i > 0);
    p.dispatch(view.width, band.rows);
  }
}

void PlanOnDevice::compose(const scene::View& view, const MarchedFilm& film, const Band& band, bool counts) {
  Program& p = *composition_;
  film.airlight.bind(at::airlight_layer);
  film.transmittance.bind(at::transmittance_layer);
  film.mean.bind(at::mean_layer);
  band.pixels.bind(at::pixels);
  film.surface.bind(at::surface);
  film.totals.bind(at::totals);
  if (film.seen) film.seen->bind(at::seen);
  p.set("has_seen", film.seen != nullptr);
  p.set("pixel_count", view.width * band.rows);
  p.set("first_pixel", view.width * band.first_row);
  p.set("has_media", march_ != nullptr);
  p.set("has_surface", reflects_ || environments_.count() > 0);
  p.set("counts", counts && (march_ || reflects_));
  p.dispatch(view.width * band.rows);
}

void PlanOnDevice::render(const scene::View& view, const MarchedFilm& film, Frame& frame, bool counts, bool looks,
                          const std::function<bool(double)>& progress) {
  const Use use(context_);
  march_rounds_.begin(looks, progress);
  surface_rounds_.begin(looks, progress);
  const std::size_t row_bytes = std::size_t(view.width) * pixel_bytes;
  const int most_rows = std::max<int>(1, int(band_bytes / row_bytes) / Rounds::tile) * Rounds::tile;
  for (int row = 0; row < view.height; row += most_rows) {
    const int rows = std::min(most_rows, view.height - row);
    const Band band{row, rows, frame.buffers.get("pixels", row_bytes * std::size_t(std::min(most_rows, view.height)))};
    if (march_) {
      frame.timer.begin("march");
      march(view, film, frame.buffers, band);
    }
    if (reflects_ || environments_.count() > 0) {
      frame.timer.begin("surfaces");
      if (reflects_) reflect(view, film, frame.buffers, band);
      add_environments(view, film, band);
    }
    frame.timer.begin("composition");
    compose(view, film, band, counts);
  }
}

void PlanOnDevice::note(Download& download) const {
  march_rounds_.note(download);
  surface_rounds_.note(download);
}
bool PlanOnDevice::unfinished(const Download& download) const {
  return march_rounds_.unfinished(download) || surface_rounds_.unfinished(download);
}

}  // namespace airlight::gpu::ray_marcher
