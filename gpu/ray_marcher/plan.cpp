#include "gpu/ray_marcher/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "gpu/view_uniforms.h"
#include "reference/ray_marcher/light_maps.h"
#include "scene/base/error.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"

namespace airlight::gpu::ray_marcher {
namespace {

constexpr double software_most = 65535;

// Iterations of exact_columns.glsl for a ray.
double iterations_without_steps(const airlight::ray_marcher::Layer& layer) {
  const double at_place = density_iterations(layer);
  if (layer.grid) return layer.grid->size[0] + layer.grid->size[1] + layer.grid->size[2];
  if (layer.gaussians) {
    if (!layer.gaussians->any_negative) return at_place;
    // Two looks at each place, and 12 at a change of sign, of which each Gaussian makes two at most.
    const std::vector<float>& rates = layer.gaussians->inverse_width;
    const double places = bounding_box(layer.varied).size().norm() * 4 * *std::max_element(rates.begin(), rates.end());
    return at_place * (2 * places + 13 * std::min(places, 2 * at_place));
  }
  if (const auto* fog = std::get_if<scene::FogmapPointer>(&layer.medium->field)) {
    const scene::IndexRange& cells = (*fog)->map.range();
    const double knots = double(height_breaks((*fog)->profile).size()), halves_of_fall = 48;
    return (cells.size[0] + cells.size[1] + knots + halves_of_fall) * (4 * at_place + knots);
  }
  const scene::TensorShape& n = std::get<scene::LegendrePointer>(layer.medium->field)->shape();
  const double points = n[0] + n[1] + n[2] - 2;
  return points * (at_place + points * 32);  // a scan of 4 * points places, and 20 looks at each change of sign
}

// Iterations of loops between two places where a march may stop and go on later: one light at one step.
double iterations_at_once(const airlight::ray_marcher::Plan& plan) {
  const airlight::ray_marcher::Options& o = plan.options;
  const bool exact = o.shadow == airlight::ray_marcher::Shadow::exact;
  double sum = 0;
  for (const airlight::ray_marcher::Layer& layer : plan.layers) {
    if (!layer.varies || o.shadow == airlight::ray_marcher::Shadow::map) continue;
    const double across = bounding_box(layer.varied).size().norm(), most = double(1 << 20);
    const double steps = o.shadow_step > 0 ? std::min(across / o.shadow_step, most) : o.shadow_steps;
    // Divided steps (deep_column): 20 / deepest of them on the way into the dark, twice for the halves, and the way
    // back up.
    if (!exact && layer.most_varied * layer.thickest * across / steps > deepest_shadow_step(o))
      sum += 4 * 20 / deepest_shadow_step(o) * (layer.grid ? 1 : 3 * density_iterations(layer));
    if (exact)
      sum += iterations_without_steps(layer);
    else if (!layer.gaussians)
      sum += steps * density_iterations(layer);
    else if (layer.gaussians->any_negative)
      sum += steps * double(layer.gaussians->count);
    else
      sum += double(layer.gaussians->count) * (1 + steps / 4);
  }
  return sum;
}

int count_balls(const std::vector<scene::Light>& lights) {
  return int(std::count_if(lights.begin(), lights.end(), [](const auto& l) { return bool(ball(l)); }));
}

Columns::Depths depths_of(const airlight::ray_marcher::Plan& plan) {
  if (needs_maps(plan)) return Columns::Depths::maps;
  const bool exact = plan.options.shadow == airlight::ray_marcher::Shadow::exact;
  return exact ? Columns::Depths::exact : Columns::Depths::columns;
}

}  // namespace

PlanOnDevice::PlanOnDevice(Context& context, const airlight::ray_marcher::Plan& plan, GridStorage storage,
                           const FirstHits* first_hits, StageTimer& timer, const std::function<bool(double)>& progress)
    : context_(context),
      plan_(plan),
      first_hits_(first_hits),
      lights_(balls_first(plan.lights)),
      balls_(count_balls(lights_)),
      has_occluders_(plan.scene->geometry && plan.scatters),
      media_(context, plan.layers, middle_of(plan.layers, plan.scene->camera.position), storage),
      columns_(context, media_, plan.scene->media, plan.layers, lights_, depths_of(plan), plan.options.map, timer,
               progress),
      march_rounds_(context, "march"),
      picture_(context, *plan.scene, media_, columns_, int(lights_.size()), plan.options, first_hits) {
  refill(solids_, context, "spheres and planes", solid_data(*plan.scene, media_.middle()));
  check_iterations();
  if (plan.layers.empty()) return;
  auto definitions = media_.definitions();
  definitions.merge(columns_.definitions());
  definitions.insert({{"LOCAL_SIZE_X", std::to_string(Rounds::tile)},
                      {"LOCAL_SIZE_Y", std::to_string(Rounds::tile)},
                      {"OCCLUDERS", has_occluders_ ? "1" : "0"},
                      {"BALL_WORDS", std::to_string(balls_ / 32 + 1)}});
  march_ = &program(context, "ray_marcher/march.comp", definitions);
}

void PlanOnDevice::check_iterations() const {
  if (context_.software() && iterations_at_once(plan_) > software_most)
    throw Unavailable(fmt::format(
        "gpu: a shadow ray may take {:.0f} iterations, {} stops after {:.0f}; expected {}", iterations_at_once(plan_),
        context_.renderer(), software_most,
        plan_.options.shadow == airlight::ray_marcher::Shadow::exact ? "shadow = march" : "fewer shadow steps"));
}

bool PlanOnDevice::is_like(const airlight::ray_marcher::Plan& next) const {
  return media_.is_like(next.layers) && next.scatters == plan_.scatters && count_balls(next.lights) == balls_ &&
         columns_.is_like(next.scene->media, next.lights, depths_of(next)) && same_surfaces(*plan_.scene, *next.scene);
}

int PlanOnDevice::become(bool same_media, StageTimer& timer, const std::function<bool(double)>& progress) {
  const Use use(context_);
  check_iterations();
  lights_ = balls_first(plan_.lights);
  if (!same_media) {
    media_.become(plan_.layers, middle_of(plan_.layers, plan_.scene->camera.position));
    refill(solids_, context_, "spheres and planes", solid_data(*plan_.scene, media_.middle()));
  }
  return columns_.become(media_, plan_.scene->media, plan_.layers, lights_, same_media, timer, progress);
}

void PlanOnDevice::march(const scene::View& view, const FilmOnDevice& film, FrameBuffers& buffers, const Band& band) {
  const airlight::ray_marcher::Options& o = plan_.options;
  Program& p = *march_;
  media_.bind(p);
  columns_.bind(p, o);
  p.set("skip_empty", o.skip_empty);
  if (film.distances) film.distances->bind(at::distances);
  band.pixels.bind(at::pixels);
  if (has_occluders_) {
    first_hits_->tree().bind(p);
    solids_->bind(at::solids);
    p.set("middle_in_tree", Vec3(media_.middle() - first_hits_->tree().middle()));
  }
  p.set("light_count", plan_.scatters ? int(plan_.lights.size()) : 0);
  p.set("balls", plan_.scatters ? balls_ : 0);
  p.set("graded", o.graded);
  p.set("steps", o.steps);
  p.set("step_length", o.step);
  p.set("horizon", o.horizon);
  p.set("deepest_step", deepest_step(o));
  p.set("darkest", o.early_exit > 0 ? float(-std::log(o.early_exit)) : far_away);
  set_camera(p, view, media_.middle());
  const int columns = (view.width + Rounds::tile - 1) / Rounds::tile;
  p.set("tile_columns", columns);
  p.set("first_row", band.first_row);
  p.set("has_distances", film.distances != nullptr);
  march_rounds_.run(p, buffers, columns * ((band.rows + Rounds::tile - 1) / Rounds::tile));
}

void PlanOnDevice::render(const scene::View& view, const FilmOnDevice& film, Frame& frame, const Buffer* totals,
                          bool looks, const std::function<bool(double)>& progress) {
  const Use use(context_);
  march_rounds_.begin(looks, progress);
  std::function<void(const Band&)> fill;
  if (march_)
    fill = [&](const Band& band) {
      frame.timer.begin("march");
      march(view, film, frame.buffers, band);
    };
  picture_.render(view, film, frame, fill, totals, looks, progress);
}

void PlanOnDevice::note(Download& download) const {
  march_rounds_.note(download);
  picture_.note(download);
}
bool PlanOnDevice::unfinished(const Download& download) const {
  return march_rounds_.unfinished(download) || picture_.unfinished(download);
}

}  // namespace airlight::gpu::ray_marcher
