#include "gpu/half_resolution_march/half_resolution_march.h"

#include <optional>
#include <utility>

#include "gpu/half_resolution_march/passes.h"
#include "reference/half_resolution_march/half_resolution_march.h"
#include "reference/half_resolution_march/limits.h"
#include "reference/half_resolution_march/passes.h"
#include "reference/half_resolution_march/stages.h"
#include "scene/backdrop.h"

namespace airlight::gpu::half_resolution_march {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedHalfResolutionMarchGpu final : public scene::Prepared {
 public:
  PreparedHalfResolutionMarchGpu(std::shared_ptr<const Scene> scene, const Options& options,
                                 ray_marcher::GridStorage storage, FirstHits::Way way, std::string settings,
                                 const Execution& execution)
      : options_(options),
        storage_(storage),
        way_(way),
        settings_(std::move(settings)),
        context_(Context::get()),
        frame_(context_) {
    prepare(std::move(scene), execution);
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  // A marched film before its blur; a picture reads one and writes the other.
  struct Kept {
    std::unique_ptr<Buffer> film;
    std::optional<View> view;  // nothing: the film is nobody's
  };
  void prepare(std::shared_ptr<const Scene>, const Execution&);
  const Buffer& room(Kept&, const View&) const;
  void draw(const View&, const Execution&, scene::Rendering&) const;

  std::shared_ptr<const Scene> scene_;
  Options options_;
  ray_marcher::GridStorage storage_;
  FirstHits::Way way_;
  std::string settings_;
  Context& context_;
  mutable Frame frame_;
  std::unique_ptr<Passes> passes_;
  std::unique_ptr<const airlight::lit_media::LitMedia> on_processor_;  // for the warning alone
  std::vector<scene::StageTime> times_;
  int maps_made_ = 0;            // for this frame; others are of frames before
  std::optional<Traffic> next_;  // of next(), if there was one
  int pictures_ = 0;             // before this one, by next()
  mutable Kept kept_[2];         // with reproject
  int history_ = 0;              // which of them is the last picture's
};

void PreparedHalfResolutionMarchGpu::prepare(std::shared_ptr<const Scene> scene, const Execution& execution) {
  const Use use(context_);
  frame_.timer.restart();
  scene_ = std::move(scene);
  if (!passes_ || !passes_->become(scene_, frame_.timer, execution.progress)) {
    passes_.reset();
    passes_ = std::make_unique<Passes>(context_, scene_, options_, storage_, way_, frame_.timer, execution.progress);
  }
  on_processor_ = std::make_unique<airlight::lit_media::LitMedia>(passes_->media().plan());
  frame_.timer.stage("upload");
  times_ = frame_.timer.times();
  maps_made_ = passes_->media().maps_made();
}

std::vector<scene::Stage> PreparedHalfResolutionMarchGpu::stages() const {
  std::vector<scene::Stage> stages = describe_stages(passes_->media().plan(), options_);
  const std::string grids = passes_->media().media().grids().description();
  stages.insert(stages.begin(), {"grids", !grids.empty(), grids.empty() ? "no voxel grid" : grids});
  const std::vector<scene::Stage> ends = passes_->ends().stages();
  stages.insert(stages.begin(), ends.begin(), ends.end());
  return stages;
}

const Buffer& PreparedHalfResolutionMarchGpu::room(Kept& kept, const View& view) const {
  const std::size_t bytes = passes_->low_bytes(view);
  if (!kept.film || kept.film->bytes() != bytes)
    kept.film = std::make_unique<Buffer>(context_, "marched film", bytes, Contents::undefined);
  return *kept.film;
}

void PreparedHalfResolutionMarchGpu::draw(const View& view, const Execution& execution,
                                          scene::Rendering& result) const {
  const Kept& before = kept_[history_];
  Kept& after = kept_[1 - history_];
  const bool keeps = options_.reproject && passes_->marches();  // a picture without media leaves the history as it is
  std::optional<History> last;
  if (options_.reproject && before.view && before.view->width == view.width && before.view->height == view.height)
    last.emplace(History{*before.film, *before.view});
  for (const bool looks : {false, true}) {
    frame_.begin(execution);
    const Buffer& low = keeps ? room(after, view) : frame_.buffers.get("marched film", passes_->low_bytes(view));
    if (keeps) after.view.reset();
    passes_->draw(view, pictures_, last ? &*last : nullptr, low, frame_, looks, execution.progress);
    frame_.finish(result);
    if (passes_->finished(frame_.download)) break;
    if (looks)
      throw Unavailable("half_resolution_march_gpu: " + context_.renderer() + " reports rays as done that are not");
  }
  if (keeps) after.view = view;
  result.counters.merge(passes_->counters(view, frame_.download));
}

scene::Rendering PreparedHalfResolutionMarchGpu::render(const View& view, const Execution& execution) const {
  require_own_camera(*scene_, view);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  const Use use(context_);
  if (passes_->draws()) {
    draw(view, execution, result);
  } else {
    ray_marcher::clear_film(result, execution);
    for (const char* name : {"rays", "points", "look_ups", "occlusion_rays"}) result.counters[name] = 0;
    if (options_.reproject) result.counters["history_used"] = result.counters["history_rejected"] = 0;
    if (options_.clamp) result.counters["history_clamped"] = 0;
  }
  if (next_) result.counters.merge(next_->counters("next_"));
  if (options_.media.self_shadow) result.counters["light_maps_made"] = maps_made_;
  result.film.metadata = {{"method", "half_resolution_march_gpu"},
                          {"settings", settings_},
                          {"scene", scene_->name},
                          {"hash", scene_->hash}};
  // Some rays on the processor, which a picture that nobody reads does not need.
  if (!execution.layers || !execution.layers->empty())
    if (const std::string doubt = doubt_of(*on_processor_, options_, *scene_, view); !doubt.empty())
      result.film.metadata["warning"] = "half_resolution_march_gpu: " + doubt;
  return result;
}

// The device keeps what still holds, and all it has where the camera alone moves. With reproject the last picture becomes the history of the
// next.
std::optional<std::vector<scene::StageTime>> PreparedHalfResolutionMarchGpu::next(std::shared_ptr<const Scene> scene,
                                                                                  const Execution& execution) {
  if (!airlight::half_resolution_march::unsupported(*scene, options_).empty() ||
      !lit_media::unsupported(*scene).empty())
    return std::nullopt;
  const Traffic before = context_.traffic();
  times_.clear();
  maps_made_ = 0;
  // Backdrops belong to a camera.
  if (scene_->backdrops.empty() && scene->backdrops.empty() &&
      airlight::lit_media::fits(passes_->media().plan(), *scene))
    scene_ = std::move(scene);
  else
    prepare(std::move(scene), execution);
  next_ = context_.traffic() - before;
  if (!options_.reproject) return times_;
  if (kept_[1 - history_].view) {
    kept_[history_].view.reset();
    history_ = 1 - history_;
  }
  ++pictures_;
  return times_;
}

}  // namespace

std::string HalfResolutionMarch::about() const {
  return "half_resolution_march in compute shaders: jittered march at half resolution, blur, upsampling by depth";
}

std::vector<scene::SettingSpec> HalfResolutionMarch::settings() const {
  auto settings = airlight::half_resolution_march::option_specs();
  settings.push_back(scene::list_settings(ray_marcher::bind_storage).front());
  settings.push_back(scene::list_settings(FirstHits::bind).front());
  return settings;
}

std::vector<std::string> HalfResolutionMarch::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::half_resolution_march::HalfResolutionMarch().supports(scene, settings);
  for (const std::string& reason : lit_media::unsupported(scene)) reasons.push_back(reason);
  return reasons;
}

std::unique_ptr<scene::Prepared> HalfResolutionMarch::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                        const scene::Settings& settings,
                                                                        const Execution& execution) const {
  return std::make_unique<PreparedHalfResolutionMarchGpu>(
      std::move(scene), airlight::half_resolution_march::read_options(settings),
      scene::read_settings(ray_marcher::bind_storage, settings), scene::read_settings(FirstHits::bind, settings),
      settings.canonical(), execution);
}

}  // namespace airlight::gpu::half_resolution_march
