#include "gpu/fogshop/fogshop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gpu/fogshop/background.h"
#include "gpu/fogshop/fog.h"
#include "gpu/fogshop/interface.h"
#include "gpu/fogshop/surface_pass.h"
#include "gpu/raster/backdrops.h"
#include "gpu/raster/first_hits.h"
#include "gpu/wavelet_fog/surface_light.h"
#include "methods/fogshop/fogshop.h"
#include "methods/fogshop/surface_lighting.h"
#include "scene/base/error.h"
#include "scene/light/light_on_ray.h"
#include "scene/media/spline_map.h"
#include "scene/single_precision.h"

namespace airlight::gpu::fogshop {
namespace {

// Steps of nodes from each light are unrolled in the shaders.

using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedFogshopGpu final : public scene::Prepared {
 public:
  PreparedFogshopGpu(std::shared_ptr<const Scene> scene, const scene::Settings& settings, const Execution& execution)
      : given_(settings),
        options_(airlight::fogshop::read_options(settings)),
        context_(Context::get()),
        frame_(context_) {
    times_ = prepare(std::move(scene), execution);
  }

  std::vector<scene::Stage> stages() const override { return plan_.stages; }
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  // Buffers of a frame on the device, null if the scene does not need them.
  struct Picture {
    const Buffer *distances = nullptr, *primitives = nullptr, *seen = nullptr, *airlight = nullptr, *surface = nullptr;
  };
  std::vector<scene::StageTime> prepare(std::shared_ptr<const Scene>, const Execution&);
  void prepare_surfaces(const airlight::fogshop::Unchanged&);
  void find_distances(const View&, Picture&) const;
  void find_airlight(const View&, Picture&) const;
  void find_surfaces(const View&, Picture&) const;
  void refuse_cut_loops(const scene::Film&) const;

  scene::Settings given_;
  airlight::fogshop::Options options_;  // as they were asked for; the model's may do without maps
  std::shared_ptr<const Scene> scene_;
  airlight::fogshop::Model model_;
  airlight::fogshop::Plan plan_;
  const airlight::fogshop::Needs& needs_ = plan_.needs;
  Context& context_;
  mutable Frame frame_;
  airlight::fogshop::SurfaceLighting lighting_;
  std::unique_ptr<FogOnDevice> fog_;
  std::unique_ptr<FirstHits> first_hits_;    // null: no surface and no ball ends rays
  std::unique_ptr<Backdrops> backdrops_;     // null: there are none
  std::unique_ptr<SurfaceShading> shading_;  // null: left out
  std::unique_ptr<Background> background_;   // null: left out
  std::vector<scene::StageTime> times_;
  int maps_made_ = 0;            // for this frame; others are of frames before
  std::optional<Traffic> next_;  // of next(), if there was one
};

// For a first frame, or one that keeps what the frame before has in common with it, on the host and on the device.
std::vector<scene::StageTime> PreparedFogshopGpu::prepare(std::shared_ptr<const Scene> scene,
                                                          const Execution& execution) {
  const Use use(context_);
  StageTimer& timer = frame_.timer;
  timer.restart();
  airlight::fogshop::Model model = airlight::fogshop::make_model(*scene, options_);
  airlight::fogshop::Plan plan = airlight::fogshop::make_plan(*scene, model);
  airlight::fogshop::Unchanged same;
  if (scene_) same = unchanged(*scene_, model_, *scene, model);
  // All that asks whether to stop comes before anything is changed.
  airlight::fogshop::SurfaceLighting lighting = airlight::fogshop::make_lighting(
      *scene, model, plan.needs, lighting_, same, execution, [&](const std::string& stage) { timer.stage(stage); });
  if (!same.surfaces) {
    first_hits_.reset();
    shading_.reset();
  }
  airlight::fogshop::Unchanged on_device = same;
  if (!fog_ || !is_like(model_, needs_, model, plan.needs)) {
    fog_.reset();
    shading_.reset();
    background_.reset();
    on_device = {};
  }
  const bool same_environment =
      fog_ && lighting_.environment == lighting.environment && (model_.fog.albedo == model.fog.albedo).all();
  scene_ = std::move(scene);
  lighting_ = std::move(lighting);
  model_ = std::move(model);
  plan_ = std::move(plan);
  if (fog_) {
    fog_->become(needs_, on_device);
  } else {
    fog_ = std::make_unique<FogOnDevice>(context_, model_, needs_);
    if (needs_.f_table) timer.stage("table of F");
  }
  if (!(first_hits_ && first_hits_->move_balls(*scene_))) first_hits_.reset();
  if (!first_hits_ && wavelet_fog::something_ends_rays(*scene_))
    first_hits_ = std::make_unique<FirstHits>(context_, *scene_);
  backdrops_ = scene_->backdrops.empty() ? nullptr : std::make_unique<Backdrops>(context_, *scene_);
  timer.stage("upload");
  maps_made_ = needs_.light_maps ? fog_->fill_light_maps() : 0;
  if (maps_made_ > 0) timer.stage("light maps");
  if (needs_.center_depths && fog_->fill_light_depths() > 0) timer.stage("depths to centres");
  if (needs_.environment_airlight && !needs_.sky_volume && !same_environment)
    fog_->upload_environment(*lighting_.environment);
  if (needs_.sky_volume && !(on_device.fog && on_device.surfaces && on_device.environments)) {
    fog_->fill_sky_volume(*scene_, execution);
    timer.stage("sky volume");
  }
  if (needs_.environment && !(background_ && (on_device.environments || background_->become(*scene_)))) {
    background_ = std::make_unique<Background>(context_, *scene_, *fog_);
    timer.stage("background");
  }
  prepare_surfaces(on_device);
  return timer.times();
}

void PreparedFogshopGpu::prepare_surfaces(const airlight::fogshop::Unchanged& same) {
  if (!needs_.surfaces) return;
  const bool made = !shading_;
  if (made) shading_ = std::make_unique<SurfaceShading>(context_, *scene_, model_, lighting_, *fog_);
  if (made || shading_->become(*scene_, *fog_, same)) frame_.timer.stage("tables of surfaces");
}

std::optional<std::vector<scene::StageTime>> PreparedFogshopGpu::next(std::shared_ptr<const Scene> scene,
                                                                      const Execution& execution) {
  if (!Fogshop().supports(*scene, given_).empty()) return std::nullopt;
  const Traffic before = context_.traffic();
  std::vector<scene::StageTime> times;
  // Backdrops belong to a camera.
  if (scene->backdrops.empty() && airlight::fogshop::camera_alone_moved(*scene_, *scene)) {
    scene_ = std::move(scene);
    plan_ = airlight::fogshop::make_plan(*scene_, model_);
    maps_made_ = 0;
  } else {
    times = prepare(std::move(scene), execution);
  }
  next_ = context_.traffic() - before;
  return times;
}

// Section 5.4, step 1: d_vp of every pixel [m], and what is seen there.
void PreparedFogshopGpu::find_distances(const View& view, Picture& picture) const {
  if (!first_hits_ && !backdrops_) return;
  frame_.timer.begin("distances");
  const std::size_t bytes = std::size_t(view.width) * view.height * 4;
  picture.distances = &frame_.buffers.get("distances", bytes);
  if (shading_) picture.primitives = &frame_.buffers.get("primitives", bytes);
  if (first_hits_) first_hits_->find(view, *picture.distances, picture.primitives);
  if (!backdrops_) return;
  picture.seen = &frame_.buffers.get("seen", 3 * bytes);
  backdrops_->find(view, *picture.distances, bool(first_hits_), *picture.seen, picture.primitives);
}

void PreparedFogshopGpu::find_airlight(const View& view, Picture& picture) const {
  if (!needs_.airlight) return;
  if (needs_.center_depths) {
    frame_.timer.begin("depths to centres");
    fog_->fill_view_depths(view.camera.position);
  }
  if (!needs_.low_resolution) {
    picture.airlight = &fog_->airlight(view, picture.distances, frame_);
    return;
  }
  const airlight::fogshop::LowResolution low{view.width, view.height, model_.options.downsample};
  const Buffer* distances = nullptr;
  if (picture.distances) {
    frame_.timer.begin("distances, low resolution");
    distances = &frame_.buffers.get("low distances", std::size_t(low.low_width()) * low.low_height() * 4);
    if (first_hits_) first_hits_->find(view, *distances, nullptr, {low.factor, 0});
    const double side = low.factor;
    if (backdrops_)
      backdrops_->find(view, *distances, bool(first_hits_), {low.low_width(), low.low_height(), side, side, 0.5, 0.5});
  }
  picture.airlight = &fog_->low_resolution_airlight(view, picture.distances, distances, frame_);
}

// Steps 4 and 7: e^-T L_p of Eq. 29.
void PreparedFogshopGpu::find_surfaces(const View& view, Picture& picture) const {
  if (!shading_ && !background_ && !backdrops_) return;
  const std::size_t bytes = std::size_t(view.width) * view.height * 12;
  Buffer& surface = frame_.buffers.get("surface", bytes);
  picture.surface = &surface;
  if (shading_) {
    frame_.timer.begin("surfaces");
    Buffer* scattered = needs_.scattered ? &frame_.buffers.get("reflected_airlight", bytes) : nullptr;
    shading_->shade(*fog_, *first_hits_, view, *picture.primitives, picture.airlight, surface, scattered);
    if (scattered) frame_.download.add("reflected_airlight", *scattered, bytes);
  } else {
    surface.clear();
  }
  if (background_) {
    frame_.timer.begin("background");
    background_->draw(*fog_, view, picture.distances, picture.airlight, surface);
  }
  frame_.download.add("surface", surface, bytes);
}

// The mark of surfaces.comp, which goes into the mean too. How long rays through the tree of surfaces take nobody knows
// before.
void PreparedFogshopGpu::refuse_cut_loops(const scene::Film& film) const {
  if (!shading_ || !context_.software()) return;
  for (const char* name : {"surface", "mean"})
    if (const auto layer = film.layers.find(name); layer != film.layers.end())
      for (const float v : layer->second)
        if (v <= -far_away)
          throw Unavailable(fmt::format(
              "gpu: shadow rays take more loop iterations than {} allows: fewer lights or a coarser mesh expected",
              context_.renderer()));
}

scene::Rendering PreparedFogshopGpu::render(const View& view, const Execution& execution) const {
  if (model_.options.source_radius == 0) require_lights_apart(*scene_, view, 1e-9, "fogshop_gpu");
  const std::string objection = unsupported_view(*scene_, model_.fog, model_.options, view.camera);
  if (!objection.empty()) throw Error(scene_->name + ": " + objection);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  const Use use(context_);
  frame_.begin(execution);
  Picture picture;
  find_distances(view, picture);
  find_airlight(view, picture);
  find_surfaces(view, picture);
  if (picture.airlight || picture.surface)
    fog_->compose(view, picture.airlight, picture.surface, picture.seen, frame_);  // L = L_a + e^-T L_p, Eq. 29
  frame_.finish(result);
  if (!picture.airlight && !picture.surface) {  // no medium, and nothing that shines
    film.add("airlight");
    film.add("mean");
    film.layers["transmittance"].assign(3 * film.pixels(), 1.0f);
  }
  if (!picture.surface) film.add("surface");
  if (execution.layers)
    for (auto layer = film.layers.begin(); layer != film.layers.end();)
      layer = execution.layers->count(layer->first) ? std::next(layer) : film.layers.erase(layer);
  refuse_cut_loops(film);
  if (!plan_.doubt.empty()) film.metadata["warning"] = "fogshop_gpu: " + plan_.doubt;
  result.counters["rays"] = double(film.pixels());
  if (next_) result.counters.merge(next_->counters("next_"));
  if (needs_.light_maps) result.counters["light_maps_made"] = maps_made_;
  result.counters["gaussians"] = model_.gaussians.count;
  result.counters["gaussians_dropped"] = model_.dropped;
  if (lighting_.depths) result.counters["average_depth_cells"] = double(lighting_.depths->cells().size());
  return result;
}

}  // namespace

std::string Fogshop::about() const {
  return "fogshop in compute shaders, single precision: variants paper and S (Zhou et al. 2007)";
}

std::vector<scene::SettingSpec> Fogshop::settings() const { return airlight::fogshop::Fogshop().settings(); }

std::vector<std::string> Fogshop::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::fogshop::Fogshop().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  if (scene.lights.size() > most_lights)
    reasons.push_back(fmt::format("{} lights: a uniform block holds {}", scene.lights.size(), most_lights));
  return reasons;
}

std::unique_ptr<scene::Prepared> Fogshop::prepare_supported(std::shared_ptr<const Scene> scene,
                                                            const scene::Settings& settings,
                                                            const Execution& execution) const {
  return std::make_unique<PreparedFogshopGpu>(std::move(scene), settings, execution);
}

}  // namespace airlight::gpu::fogshop
