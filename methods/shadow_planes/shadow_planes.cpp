#include "methods/shadow_planes/shadow_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/shadow_planes/general_position.h"
#include "methods/shadow_planes/lit_parts.h"
#include "methods/shadow_planes/paper_stages.h"
#include "methods/shadow_planes/stage_list.h"
#include "scene/base/error.h"
#include "scene/light/scattered_lights.h"

namespace airlight::shadow_planes {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

constexpr int tile_side = 16;  // pixels

struct Needs {
  bool medium = false, shadows = false, surfaces = false;
};

// Counters and times of a tile.
struct Tally {
  Counts counts;
  StageSeconds seconds;
};

// Values that are computed once per picture.
struct Frame {
  View view;
  const std::vector<ShadowVolumes>& shadows;  // by light; empty: nothing casts shadows
  std::vector<EdgeFan> fans;                  // by light, of the same
  std::vector<int> at_camera;                 // m there, by light; empty where every ray starts elsewhere
  std::optional<PaperStages> stages;          // none: lit parts of rays
};

class PreparedShadowPlanes final : public scene::Prepared {
 public:
  PreparedShadowPlanes(std::shared_ptr<const Scene> scene, const Options& options) : options_(options) {
    times_ = begin(std::move(scene));
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  std::vector<scene::StageTime> begin(std::shared_ptr<const Scene>);
  void render_tile(const Frame&, int tile_x, int tile_y, const scene::PictureLayers&, Tally&) const;
  bool ambient() const { return options_.ambient && needs_.medium && scene_->ambient_in_scatter.maxCoeff() > 0; }
  bool in_stages() const;  // of the paper

  std::shared_ptr<const Scene> scene_;
  Options options_;
  Needs needs_;
  std::vector<scene::Light> lights_;            // those that the media scatter
  std::vector<AirlightTerm> airlight_terms_;    // empty: there are none
  std::shared_ptr<const Occluders> occluders_;  // null: nothing casts shadows
  std::vector<ShadowVolumes> shadows_;          // by light; empty: the same
  int terms_made_ = 0, silhouettes_made_ = 0;   // for this frame; others are of frames before
  std::vector<scene::StageTime> times_;
};

std::vector<scene::Stage> PreparedShadowPlanes::stages() const {
  std::size_t edges = 0;
  for (const ShadowVolumes& s : shadows_) edges += s.edges().size();
  return stage_list(*scene_, options_, {lights_.size(), needs_.shadows, needs_.surfaces, in_stages(), edges});
}

// For a first scene, or one where lights, media or occluders have moved: what it needs, and the silhouettes that the
// frame before has not (section 5.1.1: of moving casters, and all of a light that moves).
std::vector<scene::StageTime> PreparedShadowPlanes::begin(std::shared_ptr<const Scene> scene) {
  const std::shared_ptr<const Scene> before = std::exchange(scene_, std::move(scene));
  lights_ = scene::scattered_lights(*scene_);
  const bool surfaces = !scene_->surfaces.empty();
  needs_.medium = std::any_of(scene_->media.begin(), scene_->media.end(), scene::extinguishes);
  needs_.surfaces = surfaces && std::any_of(scene_->lights.begin(), scene_->lights.end(), scene::shines);
  const Box air = scattering_box(scene_->media);
  needs_.shadows = surfaces && options_.shadows != Options::Shadows::none &&
                   std::any_of(lights_.begin(), lights_.end(), [&](const scene::Light& each) {
                     return any_may_shadow(scene_->surfaces, scene::ball(each)->center, air);
                   });
  terms_made_ = 0;
  if (lights_.empty() || !before || !same_media(before->media, scene_->media)) airlight_terms_.clear();
  if (!lights_.empty() && airlight_terms_.empty()) {
    airlight_terms_ = airlight_terms(scene_->media, options_);
    terms_made_ = int(airlight_terms_.size());
  }
  const std::vector<ShadowVolumes> shadows = std::exchange(shadows_, {});
  silhouettes_made_ = 0;
  if (!needs_.shadows) return {};
  std::vector<scene::StageTime> times;
  scene::Stopwatch watch;
  if (!occluders_ || occluders_->scene().geometry != scene_->geometry) {
    occluders_ = std::make_shared<const Occluders>(scene_, occluders_.get());
    times.push_back({"edges", watch.lap()});
  }
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    shadows_.emplace_back(occluders_, scene::ball(lights_[l])->center, air,
                          shadows.size() == lights_.size() ? &shadows[l] : nullptr);
    silhouettes_made_ += shadows_.back().silhouettes_made();
  }
  times.push_back({"silhouettes", watch.lap()});
  return times;
}

std::optional<std::vector<scene::StageTime>> PreparedShadowPlanes::next(std::shared_ptr<const Scene> scene,
                                                                        const Execution&) {
  if (scene->surfaces.size() != scene_->surfaces.size() || scene->lights.size() != scene_->lights.size() ||
      !unsupported(*scene, options_).empty())
    return std::nullopt;
  return begin(std::move(scene));
}

bool PreparedShadowPlanes::in_stages() const {
  if (lights_.empty()) return false;
  return options_.evaluation == Options::Evaluation::vertices ||
         (needs_.shadows && options_.shadows == Options::Shadows::stencil);
}

void PreparedShadowPlanes::render_tile(const Frame& frame, int tile_x, int tile_y, const scene::PictureLayers& layers,
                                       Tally& tally) const {
  scene::Stopwatch watch;
  const View& view = frame.view;
  const int right = std::min(view.width, (tile_x + 1) * tile_side), width = right - tile_x * tile_side;
  const int bottom = std::min(view.height, (tile_y + 1) * tile_side);
  std::vector<Pixel> pixels;
  pixels.reserve(tile_side * tile_side);
  for (int y = tile_y * tile_side; y < bottom; ++y)
    for (int x = tile_x * tile_side; x < right; ++x) {
      Pixel& pixel = pixels.emplace_back();
      pixel.ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
      pixel.end = scene::ray_end(*scene_, pixel.ray);
      if (needs_.medium) pixel.transmittance = transmittance(scene_->media, pixel.ray, {0, pixel.end.t});
      if (pixel.end.hit)
        pixel.surface =
            pixel.transmittance *
            scene::direct_light(
                *scene_, *pixel.end.hit, -pixel.ray.direction, scene_->lights,
                [&](const scene::Incident& in, std::size_t) {
                  return transmittance(scene_->media, {pixel.end.hit->position, in.to_light}, {0, in.distance});
                });
    }
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    const auto count = frame.at_camera.empty() ? std::nullopt : std::optional(frame.at_camera[l]);
    const EdgeFan* fan = needs_.shadows ? &frame.fans[l] : nullptr;
    tally.seconds.scene += watch.lap();
    if (frame.stages)
      frame.stages->draw(l, fan, count, pixels, tally.counts, tally.seconds);
    else
      add_lit_parts({airlight_terms_, lights_[l], needs_.shadows ? &frame.shadows[l] : nullptr, fan, options_.shadows},
                    count, pixels, tally.counts, tally.seconds);
    watch.lap();
  }
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    if (ambient()) pixels[k].ambient = scene_->ambient_in_scatter * (1 - pixels[k].transmittance);
    layers.put(tile_x * tile_side + int(k) % width, tile_y * tile_side + int(k) / width, pixels[k]);
  }
  tally.seconds.scene += watch.lap();
}

scene::Rendering PreparedShadowPlanes::render(const View& view, const Execution& execution) const {
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  const scene::PictureLayers layers(result.film, {.ambient = ambient()});
  if (options_.evaluation == Options::Evaluation::vertices && view.camera.kind != scene::Camera::Kind::perspective)
    throw Error("evaluation = vertices is for perspective cameras");
  const int columns = (view.width + tile_side - 1) / tile_side, rows = (view.height + tile_side - 1) / tile_side;
  scene::Stopwatch watch;
  Frame frame{view, shadows_, {}, {}, {}};
  for (const ShadowVolumes& shadows : frame.shadows) frame.fans.emplace_back(shadows, view.camera);
  if (view.camera.kind == scene::Camera::Kind::perspective)
    for (const ShadowVolumes& shadows : frame.shadows)
      frame.at_camera.push_back(shadows.count(origin_in_general_position(view.camera.position, shadows.light())));
  const double fans = watch.lap();
  std::optional<PaperStages>& stages = frame.stages;
  if (in_stages())
    stages.emplace(*scene_, lights_, options_, airlight_terms_, frame.shadows, view.camera, execution.threads);
  const StageSeconds once = stages ? stages->seconds() : StageSeconds();
  watch.lap();
  std::vector<Tally> tallies(std::size_t(columns) * rows);
  scene::parallel_for(columns * rows, execution,
                      [&](int tile) { render_tile(frame, tile % columns, tile / columns, layers, tallies[tile]); });
  const double wall = watch.lap();
  Tally all;
  for (const Tally& t : tallies) {
    all.counts.parts += t.counts.parts;
    all.counts.crossings += t.counts.crossings;
    all.counts.by_pixel += t.counts.by_pixel;
    all.seconds.scene += t.seconds.scene;
    all.seconds.ends += t.seconds.ends;
    all.seconds.sort += t.seconds.sort;
    all.seconds.planes += t.seconds.planes;
  }
  // The tiles' wall clock, shared out as their stages took it.
  const StageSeconds& of = all.seconds;
  const double share = wall / std::max(1e-300, of.scene + of.ends + of.sort + of.planes);
  const auto add_time = [&](const char* stage, double seconds) { result.times.push_back({stage, seconds}); };
  if (stages) {
    add_time("surfaces and stencil", fans + of.scene * share);
    add_time("medium on surfaces", once.ends + of.ends * share);
    if (needs_.shadows) {
      add_time("sort", once.sort + of.sort * share);
      add_time("shadow planes", once.planes + of.planes * share);
    }
  } else {
    add_time(needs_.surfaces ? "surfaces" : "camera rays", fans + of.scene * share);
    if (of.planes > 0) add_time("airlight", of.planes * share);
  }
  const double vertices = stages ? double(stages->vertices()) : 0;
  result.counters["rays"] = double(result.film.pixels());
  result.counters["lit_parts"] = all.counts.parts;
  result.counters["crossings"] = all.counts.crossings;
  result.counters["airlight_terms_made"] = terms_made_;
  result.counters["silhouettes_made"] = silhouettes_made_;
  result.counters["gamma_evaluations"] = all.counts.by_pixel + vertices;
  if (stages) result.counters["planes"] = double(stages->planes());
  if (options_.evaluation == Options::Evaluation::vertices) result.counters["vertices"] = vertices;
  return result;
}

}  // namespace

std::string ShadowPlanes::about() const {
  return "single scattering of point and spot lights in homogeneous media with exact shadows (Biri et al. 2006)";
}

std::vector<scene::SettingSpec> ShadowPlanes::settings() const { return setting_specs(); }

std::vector<std::string> ShadowPlanes::supports(const Scene& scene, const scene::Settings& settings) const {
  return unsupported(scene, read_options(settings));
}

std::unique_ptr<scene::Prepared> ShadowPlanes::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                 const scene::Settings& settings,
                                                                 const Execution&) const {
  return std::make_unique<PreparedShadowPlanes>(std::move(scene), read_options(settings));
}

}  // namespace airlight::shadow_planes
