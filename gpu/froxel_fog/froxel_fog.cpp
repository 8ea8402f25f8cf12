#include "gpu/froxel_fog/froxel_fog.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "gpu/froxel_fog/volume.h"
#include "gpu/ray_marcher/ray_ends.h"
#include "reference/froxel_fog/doubt.h"
#include "reference/froxel_fog/frames.h"
#include "reference/froxel_fog/froxel_fog.h"
#include "reference/froxel_fog/stages.h"
#include "scene/base/error.h"
#include "scene/media/same_medium.h"

namespace airlight::gpu::froxel_fog {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

constexpr double farthest = 1e6, nearest = 1e-9;  // [m] of slices, as of scenes (scene/single_precision.h)

// A scene on the device.
struct SceneOnDevice {
  airlight::lit_media::Plan plan;
  ray_marcher::RayEnds ends;
  std::unique_ptr<lit_media::LitMedia> lit;       // null: nothing is to be seen
  std::unique_ptr<ray_marcher::Picture> picture;  // null: nothing is to be seen

  SceneOnDevice(Context& context, std::shared_ptr<const Scene> scene, const Options& options,
                ray_marcher::GridStorage storage, FirstHits::Way way, Frame& frame, const Execution& execution)
      : plan(make_plan(std::move(scene), options.media)), ends(context, *plan.scene, way) {
    const int lights = int(plan.lights.size());
    if (plan.layers.empty() && !ray_marcher::something_behind(*plan.scene, plan.lights.size())) return;
    lit =
        std::make_unique<lit_media::LitMedia>(context, plan, storage, ends.surfaces(), frame.timer, execution.progress);
    picture = std::make_unique<ray_marcher::Picture>(context, *plan.scene, lit->media(), lit->columns(), lights,
                                                     marched, ends.surfaces());
  }
  SceneOnDevice(const SceneOnDevice&) = delete;

  // Becomes the scene of the next frame where programs and buffers serve it, and uploads what has changed. False, and nothing is done, where
  // they do not.
  bool become(std::shared_ptr<const Scene> scene, const Options& options, Frame& frame, const Execution& execution) {
    airlight::lit_media::Plan next = make_plan(std::move(scene), options.media, &plan);
    if (!lit || next.layers.empty() != plan.layers.empty() || !lit->is_like(next)) return false;
    if (!ends.become(*plan.scene, *next.scene) || !picture->become(*next.scene)) return false;
    const bool same_media = scene::same_media(plan.scene->media, next.scene->media);
    plan = std::move(next);
    lit->become(same_media, frame.timer, execution.progress);
    return true;
  }

 private:
  airlight::ray_marcher::Options marched;  // nothing is
};

class PreparedFogGpu final : public scene::Prepared {
 public:
  PreparedFogGpu(std::shared_ptr<const Scene> scene, const scene::Settings& settings, const Execution& execution)
      : given_(settings),
        options_(airlight::froxel_fog::read_options(airlight::froxel_fog::effective_settings(settings))),
        settings_(airlight::froxel_fog::effective_settings(settings).canonical()),
        context_(Context::get()),
        frame_(context_) {
    take(std::move(scene), execution, false);
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  // Keeps on the device what is still valid. With reproject, the last picture becomes the history of the
  // next, as on the CPU.
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  // Prepares the scene's pictures. `next`: as the frame after the last one, else as the first frame.
  void take(std::shared_ptr<const Scene>, const Execution&, bool next);
  // Returns false if there were too few rounds: draw again with `looks`.
  bool draw(const View&, const Execution&, bool looks, scene::Rendering&) const;
  void count(const View&, scene::Rendering&) const;
  void warn(const View&, scene::Film&) const;

  scene::Settings given_;
  Options options_;
  std::string settings_;  // effective ones
  Context& context_;
  mutable Frame frame_;
  std::unique_ptr<SceneOnDevice> scene_;
  std::vector<scene::StageTime> times_;
  int pictures_ = 0;  // before this one, by next()
  std::unique_ptr<Froxels> history_;
  mutable Froxels froxels_;         // of the last render
  mutable bool drawn_ = false;      // was there one since the last next()?
  std::optional<Traffic> next_;     // of next(), if there was one
  std::unique_ptr<Volume> volume_;  // null: there are no media
  mutable std::unique_ptr<const airlight::lit_media::LitMedia>
      on_processor_;  // for the warning alone; null: not needed yet
};

void PreparedFogGpu::take(std::shared_ptr<const Scene> scene, const Execution& execution, bool next) {
  const Use use(context_);
  frame_.timer.restart();
  on_processor_.reset();  // of the scene before
  if (scene_ && scene_->become(scene, options_, frame_, execution)) {
    // Without reproject the volume is that of the last picture.
    if (!options_.reproject) {
      frame_.timer.stage("upload");
      times_ = frame_.timer.times();
      return;
    }
    volume_.reset();
  } else {
    volume_.reset();
    scene_ = std::make_unique<SceneOnDevice>(context_, std::move(scene), options_,
                                             scene::read_settings(ray_marcher::bind_storage, given_),
                                             scene::read_settings(FirstHits::bind, given_), frame_, execution);
  }
  if (next && options_.reproject) {
    ++pictures_;
    // A picture that saw no medium leaves the history that it began with.
    if (drawn_ && (options_.far > 0 || froxels_.slices->download<float>()[2] != 0)) {
      // The buffers of the history before are those of the next picture.
      if (!history_) history_ = std::make_unique<Froxels>();
      std::swap(*history_, froxels_);
    }
    drawn_ = false;
  }
  if (!scene_->plan.layers.empty()) {
    std::vector<std::array<float, 4>> frames;
    for (int frame = 0; frame < options_.frames; ++frame) {
      const Vec3 look = airlight::froxel_fog::jitter(options_.jitter, pictures_ + frame);
      frames.push_back(
          {float(look[0]), float(look[1]), float(look[2]), airlight::froxel_fog::history_weight(options_, frame)});
    }
    volume_ = std::make_unique<Volume>(context_, options_, *scene_->lit,
                                       Ends{scene_->ends.surfaces(), scene_->ends.backdrops()}, frames, history_.get());
  }
  frame_.timer.stage("upload");
  times_ = frame_.timer.times();
}

std::vector<scene::Stage> PreparedFogGpu::stages() const {
  std::vector<scene::Stage> stages = scene_->ends.stages();
  const std::string grids = scene_->lit ? scene_->lit->media().grids().description() : "";
  stages.push_back({"grids", !grids.empty(), grids.empty() ? "no voxel grid" : grids});
  for (scene::Stage& stage : airlight::froxel_fog::describe_stages(scene_->plan, options_, settings_))
    stages.push_back(std::move(stage));
  return stages;
}

bool PreparedFogGpu::draw(const View& view, const Execution& execution, bool looks, scene::Rendering& result) const {
  frame_.begin(execution);
  const ray_marcher::FilmOnDevice film = scene_->ends.begin_film(view, frame_);
  const bool counts = frame_.download.wants_any();
  std::function<void(const ray_marcher::Band&)> fill;
  if (volume_) {
    volume_->make(view, film.distances, froxels_, frame_, counts, looks, execution.progress);
    volume_->note(frame_, froxels_);
    fill = [&](const ray_marcher::Band& band) { volume_->look_up(view, film.distances, froxels_, band, frame_); };
  }
  scene_->picture->render(view, film, frame_, fill, nullptr, looks, execution.progress);
  scene_->picture->note(frame_.download);
  frame_.finish(result);
  return !(volume_ && volume_->unfinished(frame_.download)) && !scene_->picture->unfinished(frame_.download);
}

void PreparedFogGpu::count(const View& view, scene::Rendering& result) const {
  const std::vector<double> counted = ray_marcher::totals_of(frame_.download, "froxel totals");
  const std::vector<float> range = frame_.download.values<float>("range");
  if (volume_ && range.empty()) return;  // nothing came down
  const bool any = volume_ && range[2] != 0;
  const char* const names[] = {"points", "look_ups", "occlusion_rays", "reprojected"};
  for (std::size_t i = 0; i < (options_.reproject ? 4 : 3); ++i)
    result.counters[names[i]] = any && i < counted.size() ? counted[i] : 0;
  const auto& cells = froxels_.cells;
  result.counters["froxels"] = any ? airlight::froxel_fog::count_froxels(options_, view.width, view.height) : 0;
  result.counters["rays"] =
      double(result.film.pixels()) + (any ? double(cells.columns) * cells.rows * options_.frames : 0);
}

// A picture that nobody reads needs no warning.
void PreparedFogGpu::warn(const View& view, scene::Film& film) const {
  const std::vector<float> range = frame_.download.values<float>("range");
  if (!volume_ || range.empty() || range[2] == 0) return;
  if (!on_processor_) on_processor_ = std::make_unique<airlight::lit_media::LitMedia>(scene_->plan);
  const Interval slices{range[0], range[1]};
  const std::string doubt = airlight::froxel_fog::doubt_of(*on_processor_, options_, slices, *scene_->plan.scene, view);
  if (!doubt.empty()) film.metadata["warning"] = "froxel_fog_gpu: " + doubt;
}

scene::Rendering PreparedFogGpu::render(const View& view, const Execution& execution) const {
  require_own_camera(*scene_->plan.scene, view);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  const Use use(context_);
  if (!scene_->lit)
    ray_marcher::clear_film(result, execution);
  else if (!draw(view, execution, false, result) && !draw(view, execution, true, result))
    throw Unavailable("froxel_fog_gpu: " + context_.renderer() + " reports froxels as done that are not");
  drawn_ = bool(volume_);
  count(view, result);
  if (next_) result.counters.merge(next_->counters("next_"));
  if (options_.media.self_shadow) result.counters["light_maps_made"] = scene_->lit ? scene_->lit->maps_made() : 0;
  const Scene& scene = *scene_->plan.scene;
  result.film.metadata = {
      {"method", "froxel_fog_gpu"}, {"settings", settings_}, {"scene", scene.name}, {"hash", scene.hash}};
  warn(view, result.film);
  return result;
}

std::optional<std::vector<scene::StageTime>> PreparedFogGpu::next(std::shared_ptr<const Scene> scene,
                                                                  const Execution& execution) {
  if (!FroxelFog().supports(*scene, given_).empty()) return std::nullopt;
  const Traffic before = context_.traffic();
  take(std::move(scene), execution, true);
  next_ = context_.traffic() - before;
  return times_;
}

}  // namespace

std::string FroxelFog::about() const {
  return "single scattering on a grid of froxels in compute shaders, the grid of froxel_fog in single precision";
}

std::vector<scene::SettingSpec> FroxelFog::settings() const {
  auto settings = airlight::froxel_fog::option_specs();
  settings.push_back(scene::list_settings(ray_marcher::bind_storage).front());
  settings.push_back(scene::list_settings(FirstHits::bind).front());
  return settings;
}

std::vector<std::string> FroxelFog::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::froxel_fog::FroxelFog().supports(scene, settings);
  for (const std::string& reason : lit_media::unsupported(scene)) reasons.push_back(reason);
  if (!reasons.empty()) return reasons;
  const Options o = airlight::froxel_fog::read_options(airlight::froxel_fog::effective_settings(settings));
  for (const auto& [name, depth] : {std::pair{"near", o.near}, {"far", o.far}})
    if (depth != 0 && !(depth >= nearest && depth <= farthest))
      reasons.push_back(
          fmt::format("{} = {:.3g} m: shaders compute in single precision, expected 0 or {:.0e} to {:.0e}", name, depth,
                      nearest, farthest));
  return reasons;
}

std::unique_ptr<scene::Prepared> FroxelFog::prepare_supported(std::shared_ptr<const Scene> scene,
                                                              const scene::Settings& settings,
                                                              const Execution& execution) const {
  return std::make_unique<PreparedFogGpu>(std::move(scene), settings, execution);
}

}  // namespace airlight::gpu::froxel_fog
