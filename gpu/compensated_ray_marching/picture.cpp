#include "gpu/compensated_ray_marching/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/film_layers.h"
#include "gpu/view_uniforms.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/light/scattered_lights.h"
#include "scene/single_precision.h"

namespace airlight::gpu::compensated_ray_marching {

using airlight::compensated_ray_marching::EnvironmentBands;
using airlight::compensated_ray_marching::ResidualStore;
using airlight::compensated_ray_marching::smoke_box;
using scene::Execution;
using scene::Scene;
using scene::View;

std::vector<std::string> unsupported_on_device(const Scene& scene, const Options& options) {
  std::vector<std::string> reasons = airlight::compensated_ray_marching::unsupported(scene, options);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  for (const std::string& reason : unsupported_smoke(scene)) reasons.push_back(reason);
  return reasons;
}

void append(std::vector<scene::StageTime>& times, const std::vector<scene::StageTime>& more) {
  for (const scene::StageTime& time : more) {
    const auto same = std::find_if(times.begin(), times.end(), [&](const auto& t) { return t.name == time.name; });
    if (same == times.end())
      times.push_back(time);
    else
      same->seconds += time.seconds;
  }
}

std::unique_ptr<Picture> prepare_picture(std::shared_ptr<const Scene> scene, const Options& options,
                                         std::string settings, Solution last, const Execution& execution) {
  const auto prepare = options.variant == Options::Variant::paper ? prepare_paper_picture : prepare_grid_picture;
  return prepare(std::move(scene), options, std::move(settings), std::move(last), execution);
}

Picture::Picture(std::shared_ptr<const Scene> scene, const Options& options, std::string settings, Solution last)
    : first_(scene),
      scene_(std::move(scene)),
      options_(options),
      settings_(std::move(settings)),
      last_(std::move(last)),
      context_(Context::get()),
      frame_(context_) {
  if (options_.paper.store == ResidualStore::automatic) options_.paper.store = ResidualStore::bricks;
  for (const scene::Medium& medium : scene_->media)
    if (extinguishes(medium) && !smoke_box(medium).empty()) smoke_.emplace(medium, options_);
  scatters_ = smoke_ && scene::why_nothing_scatters(*scene_).empty();
  const Use use(context_);
  StageTimer timer(context_);
  timer.begin("upload");
  surroundings_ = std::make_unique<Surroundings>(context_, *scene_);
  append(times_, timer.times());
}

EnvironmentBands Picture::bands(int order) {
  return EnvironmentBands(order, [this, order](const std::shared_ptr<const scene::EnvironmentMap>& map) {
    if (!projection_) projection_ = std::make_unique<MapProjection>(context_, order);
    return projection_->of(*map, surroundings_->environments().texels(map));
  });
}

void Picture::begin_march() {
  composition_ = &program(context_, "smoke_composition", 64, 1, {});
  if (!smoke_) return;
  const Box box = smoke_box(smoke_->medium());
  middle_ = box.center();
  slice_ = box.size().maxCoeff() / options_.slices;
  density_ = std::make_unique<SmokeDensity>(context_, *smoke_, middle_, options_.variant == Options::Variant::paper);
  ranges_ = &program(context_, "ranges", pixel_tile, pixel_tile, density_->definitions());
  Definitions definitions = density_->definitions();
  definitions["SCATTERS"] = scatters_ ? "1" : "0";
  march_ = &program(context_, "march", pixel_tile, pixel_tile, definitions);
}

std::optional<std::vector<scene::StageTime>> Picture::next(std::shared_ptr<const Scene> scene,
                                                           const Execution& execution) {
  if (scene->matter_hash != scene_->matter_hash ||
      !airlight::compensated_ray_marching::unsupported(*scene, options_).empty() || !fits(*scene) ||
      (smoke_ && !scatters_ && scene::why_nothing_scatters(*scene).empty()))
    return std::nullopt;
  const Use use(context_);
  const bool lit = !scene->light_hash.empty() && scene->light_hash == lit_by_;
  lit_by_ = scene->light_hash;
  scene_ = std::move(scene);
  surroundings_->become(*scene_);
  return lit ? std::vector<scene::StageTime>{} : light(execution);
}

std::unique_ptr<Picture> Picture::in_other_smoke(std::shared_ptr<const Scene> scene, const Execution& execution) const {
  if (!unsupported_on_device(*scene, options_).empty()) return nullptr;
  const Use use(context_);
  Solution now = solution();
  if (now.empty()) now = last_;
  if (now.empty()) return nullptr;
  return prepare_picture(std::move(scene), options_, settings_, std::move(now), execution);
}

std::vector<scene::Stage> Picture::stages() const {
  const std::string none = "no medium extinguishes";
  const std::string dark = smoke_ ? scene::why_nothing_scatters(*scene_) : none;
  const auto [again, how_again] = multiple();
  const auto volume = volume_pass();
  return {{"single scattering", scatters_, scatters_ ? single() : dark},
          {"multiple scattering", again, scatters_ ? how_again : dark},
          {"residual", smoke_ && smoke_->with_residual(),
           !smoke_                   ? none
           : smoke_->with_residual() ? fmt::format("added to the Gaussians, from {}", smoke_->residual()->name())
           : options_.variant == Options::Variant::paper ? "the Gaussians are all"
                                                         : "the field itself is marched through"},
          {"volume pass", volume.has_value(), volume.value_or("no Gaussians with voxels of variant = paper")},
          {"march", smoke_.has_value(), smoke_ ? fmt::format("slices of {:.3g} m", slice_) : none},
          {"ends", surroundings_->ends(),
           surroundings_->ends() ? "where surfaces and backdrops end camera rays" : "nothing ends a ray"},
          {"surfaces", bool(surroundings_->surfaces()), surroundings_->surfaces() ? surfaces_lit() : "there are none"},
          {"background", surroundings_->behind(),
           surroundings_->behind() ? "environments through the smoke" : "nothing stands behind"},
          {"composition", true, "layers of the film"}};
}

void Picture::march(const View& view) const {
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  const Buffer& ranges = frame_.buffers.get("ranges", 16 * pixels);
  const Buffer &airlight = frame_.buffers.get("airlight", 12 * pixels),
               &column = frame_.buffers.get("column", 4 * pixels);
  Program& find = *ranges_;
  const bool ends = surroundings_->ends();
  (ends ? of_pixels("distances", view, 4) : ranges).bind(at::distances);
  find.set("has_ends", ends);
  ranges.bind(at::ranges);
  airlight.bind(at::airlight_layer);
  column.bind(at::column);
  set_camera(find, view, middle_);
  density_->bind(find);
  find.set("slice", slice_);
  find.set("farthest", density_->widths2());
  find.dispatch(view.width, view.height);
  Program& p = *march_;
  set_camera(p, view, middle_);
  density_->bind(p);
  bind_source(p);
  p.set("sigma_t", smoke_->medium().sigma_t);
  p.set("weight", int(options_.weight));
  const int most = int(std::ceil(density_->longest() / slice_)) + 2;
  for (int first = 0; first < most; first += density_->slices()) {
    p.set("first_slice", first);
    p.dispatch(view.width, view.height);
  }
}

void Picture::compose(const View& view) const {
  Program& p = *composition_;
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  bind_film_layers(frame_, pixels, p,
                   {at::mean_layer, at::transmittance_layer, at::surface_layer, at::airlight_layer, at::ambient_layer},
                   {true, ambient() ? std::optional(scene_->ambient_in_scatter) : std::nullopt});
  p.set("pixels", int(pixels));
  const Buffer& column = of_pixels("column", view, 4);
  column.bind(at::column);
  p.set("sigma_t", smoke_ ? smoke_->medium().sigma_t : Rgb(Rgb::Zero()));
  p.set("has_smoke", smoke_.has_value());
  p.set("has_behind", surroundings_->behind());
  const bool lit = surroundings_->surfaces(), seen = surroundings_->backdrops();
  (lit ? of_pixels("lit", view, sizeof(wavelet_fog::LitData)) : column).bind(at::lit);
  (seen ? of_pixels("seen", view, 12) : column).bind(at::seen);
  p.set("has_lit", lit);
  p.set("has_seen", seen);
  p.dispatch(int(pixels));
}

scene::Rendering Picture::render(const View& view, const Execution& execution) const {
  const Use use(context_);
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  frame_.begin(execution);
  if (surroundings_->ends()) {
    frame_.timer.begin("ends");
    surroundings_->find_ends(view, frame_);
  }
  if (smoke_) {
    find_source(view);
    frame_.timer.begin("march");
    march(view);
  }
  if (surroundings_->surfaces()) {
    frame_.timer.begin("surfaces");
    light_surfaces(view);
  }
  if (surroundings_->behind()) {
    frame_.timer.begin("background");
    surroundings_->look_behind(view, frame_);
  }
  frame_.timer.begin("composition");
  compose(view);
  frame_.finish(result);
  result.counters["rays"] = double(pixels);
  count(result.counters);
  result.film.metadata = {{"method", "compensated_ray_marching_gpu"},
                          {"settings", settings_},
                          {"scene", scene_->name},
                          {"hash", scene_->hash}};
  const std::string doubt = airlight::compensated_ray_marching::doubt_of(*scene_, options_, multiple().first);
  if (!doubt.empty()) result.film.metadata["warning"] = "compensated_ray_marching_gpu: " + doubt;
  return result;
}

}  // namespace airlight::gpu::compensated_ray_marching
