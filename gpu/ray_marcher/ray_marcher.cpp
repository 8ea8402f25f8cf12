#include "gpu/ray_marcher/ray_marcher.h"

#include <algorithm>

#include "gpu/ray_marcher/plan.h"
#include "gpu/ray_marcher/scene_data.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "reference/ray_marcher/stages.h"
#include "scene/base/error.h"
#include "scene/light/light_on_ray.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/same_medium.h"
#include "scene/single_precision.h"

namespace airlight::gpu::ray_marcher {
namespace {

using airlight::ray_marcher::Plan;
using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedMarchGpu final : public scene::Prepared {
 public:
  PreparedMarchGpu(std::shared_ptr<const Scene> scene, const scene::Settings& settings, const Execution& execution)
      : settings_(settings), context_(Context::get()), frame_(context_) {
    prepare(std::move(scene), execution);
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  void prepare(std::shared_ptr<const Scene>, const Execution&);
  bool become(Plan& next, const Execution&);
  // False where rounds were too few: the same again, looking.
  bool draw(const View&, const Execution&, bool looks, scene::Rendering&) const;

  scene::Settings settings_;
  Context& context_;
  mutable Frame frame_;
  Plan plan_;
  std::unique_ptr<RayEnds> ends_;
  std::unique_ptr<PlanOnDevice> device_;  // null: no medium with extinction, and nothing that shines
  std::vector<scene::StageTime> times_;
  int maps_made_ = 0;            // for this frame; others are of frames before
  std::optional<Traffic> next_;  // of next(), if there was one
};

void PreparedMarchGpu::prepare(std::shared_ptr<const Scene> scene, const Execution& execution) {
  const Use use(context_);
  frame_.timer.restart();
  const auto options = airlight::ray_marcher::read_options(settings_, airlight::ray_marcher::length_unit(*scene));
  Plan plan = make_plan(std::move(scene), options, plan_.scene ? &plan_ : nullptr);
  if (!become(plan, execution)) {
    device_.reset();
    ends_.reset();
    plan_ = std::move(plan);
    ends_ = std::make_unique<RayEnds>(context_, *plan_.scene, scene::read_settings(FirstHits::bind, settings_));
    if (!plan_.layers.empty() || something_behind(*plan_.scene, plan_.lights.size()))
      device_ = std::make_unique<PlanOnDevice>(context_, plan_, scene::read_settings(bind_storage, settings_),
                                               ends_->surfaces(), frame_.timer, execution.progress);
    maps_made_ = device_ && device_->has_maps() ? int(plan_.lights.size()) : 0;
  }
  frame_.timer.stage("upload");
  times_ = frame_.timer.times();
}

// Keeps what is on the device where programs and buffers serve the next plan. False, and nothing is done, where they do not.
bool PreparedMarchGpu::become(Plan& next, const Execution& execution) {
  if (!device_ || next.layers.empty() != plan_.layers.empty() || !device_->is_like(next)) return false;
  if (!ends_->become(*plan_.scene, *next.scene) || !device_->become_lit(*next.scene)) return false;
  const bool same_media = scene::same_media(plan_.scene->media, next.scene->media);
  plan_ = std::move(next);
  maps_made_ = device_->become(same_media, frame_.timer, execution.progress);
  return true;
}

std::optional<std::vector<scene::StageTime>> PreparedMarchGpu::next(std::shared_ptr<const Scene> scene,
                                                                    const Execution& execution) {
  if (!RayMarcher().supports(*scene, settings_).empty()) return std::nullopt;
  const Traffic before = context_.traffic();
  prepare(std::move(scene), execution);
  next_ = context_.traffic() - before;
  return times_;
}

std::vector<scene::Stage> PreparedMarchGpu::stages() const {
  std::vector<scene::Stage> stages = describe_stages(plan_);
  const std::string grids = device_ ? device_->grids().description() : "";
  std::vector<scene::Stage> first = ends_->stages();
  first.push_back({"grids", !grids.empty(), grids.empty() ? "no voxel grid" : grids});
  stages.insert(stages.begin(), first.begin(), first.end());
  return stages;
}

bool PreparedMarchGpu::draw(const View& view, const Execution& execution, bool looks, scene::Rendering& result) const {
  frame_.begin(execution);
  Buffer& totals = frame_.buffers.get("totals", 8 * sizeof(unsigned));
  const FilmOnDevice film = ends_->begin_film(view, frame_);
  const bool counts = frame_.download.wants_any();
  if (counts) totals.clear();
  device_->render(view, film, frame_, counts ? &totals : nullptr, looks, execution.progress);
  frame_.download.add_values("totals", totals, totals.bytes());
  device_->note(frame_.download);
  frame_.finish(result);
  if (device_->unfinished(frame_.download)) return false;
  const std::vector<double> counted = totals_of(frame_.download, "totals");
  const bool maps = device_->has_maps();  // of which shaders count look-ups
  if (plan_.options.shadow == airlight::ray_marcher::Shadow::map)
    for (const char* counter : {"shadow_rays", "look_ups"}) result.counters[counter] = 0;
  const char* const counters[] = {"steps", maps ? "look_ups" : "shadow_rays", "shadow_steps", "occlusion_rays"};
  for (std::size_t i = 0; i < counted.size(); ++i) result.counters[counters[i]] = counted[i];
  return true;
}

scene::Rendering PreparedMarchGpu::render(const View& view, const Execution& execution) const {
  require_lights_apart(*plan_.scene, view, 1e-9, "ray_marcher_gpu");
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  const Use use(context_);
  if (!device_) {  // no medium, and nothing that shines
    clear_film(result, execution);
    for (const char* name : {"steps", "shadow_rays", "shadow_steps", "occlusion_rays"}) result.counters[name] = 0;
    if (plan_.options.shadow == airlight::ray_marcher::Shadow::map) result.counters["look_ups"] = 0;
  } else if (!draw(view, execution, false, result) && !draw(view, execution, true, result)) {
    throw Unavailable("ray_marcher_gpu: " + context_.renderer() + " reports rays as done that are not");
  }
  result.counters["rays"] = double(result.film.pixels());
  if (next_) result.counters.merge(next_->counters("next_"));
  if (plan_.options.shadow == airlight::ray_marcher::Shadow::map) result.counters["light_maps_made"] = maps_made_;
  result.film.metadata = {{"method", "ray_marcher_gpu"},
                          {"settings", settings_.canonical()},
                          {"scene", plan_.scene->name},
                          {"hash", plan_.scene->hash}};
  return result;
}

}  // namespace

std::string RayMarcher::about() const {
  return "brute-force single scattering in compute shaders, the steps of ray_marcher in single precision";
}

std::vector<scene::SettingSpec> RayMarcher::settings() const {
  auto settings = airlight::ray_marcher::option_specs();
  settings.push_back(scene::list_settings(bind_storage).front());
  settings.push_back(scene::list_settings(FirstHits::bind).front());
  return settings;
}

std::vector<std::string> RayMarcher::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::ray_marcher::RayMarcher().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  const airlight::ray_marcher::Options options = airlight::ray_marcher::read_options(settings, 1);
  if (!options.simd) reasons.push_back("kernel = scalar is for the CPU: shaders compute in single precision");
  return reasons;
}

std::unique_ptr<scene::Prepared> RayMarcher::prepare_supported(std::shared_ptr<const Scene> scene,
                                                               const scene::Settings& settings,
                                                               const Execution& execution) const {
  return std::make_unique<PreparedMarchGpu>(std::move(scene), settings, execution);
}

}  // namespace airlight::gpu::ray_marcher
