#include "gpu/ray_marcher/ray_marcher.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/raster/backdrops.h"
#include "gpu/raster/first_hits.h"
#include "gpu/ray_marcher/plan.h"
#include "gpu/ray_marcher/scene_data.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "reference/ray_marcher/stages.h"
#include "scene/base/error.h"
#include "scene/light/background.h"
#include "scene/light/light_on_ray.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/single_precision.h"

namespace airlight::gpu::ray_marcher {
namespace {

using airlight::ray_marcher::Plan;
using scene::Execution;
using scene::Scene;
using scene::View;

// Surfaces, or balls of lights.
bool something_ends_rays(const Scene& scene) {
  return scene.geometry || std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& light) {
           const auto ball = scene::ball(light);
           return ball && ball->radius > 0;
         });
}

class PreparedMarchGpu final : public scene::Prepared {
 public:
  PreparedMarchGpu(Plan plan, std::string settings, GridStorage storage, FirstHits::Way way, const Execution& execution)
      : plan_(std::move(plan)), settings_(std::move(settings)), context_(Context::get()), frame_(context_) {
    frame_.timer.restart();
    const bool ends = something_ends_rays(*plan_.scene);
    if (ends) first_hits_ = std::make_unique<FirstHits>(context_, *plan_.scene, true, way);
    if (!plan_.scene->backdrops.empty()) backdrops_ = std::make_unique<Backdrops>(context_, *plan_.scene);
    const bool seen =
        (plan_.scene->geometry && !plan_.lights.empty()) || has_environment(*plan_.scene) || bool(backdrops_);
    if (!plan_.layers.empty() || seen)
      device_ =
          std::make_unique<PlanOnDevice>(context_, plan_, storage, first_hits_.get(), frame_.timer, execution.progress);
    frame_.timer.stage("upload");
    times_ = frame_.timer.times();
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;

 private:
  // False where rounds were too few: the same again, looking.
  bool draw(const View&, const Execution&, bool looks, scene::Rendering&) const;

  Plan plan_;
  std::string settings_;
  Context& context_;
  mutable Frame frame_;
  std::unique_ptr<FirstHits> first_hits_;  // null: rays are infinite
  std::unique_ptr<Backdrops> backdrops_;   // null: there are none
  std::unique_ptr<PlanOnDevice> device_;   // null: no medium with extinction, and nothing that shines
  std::vector<scene::StageTime> times_;
};

std::vector<scene::Stage> PreparedMarchGpu::stages() const {
  std::vector<scene::Stage> stages = describe_stages(plan_);
  const std::string grids = device_ ? device_->grids().description() : "";
  stages.insert(stages.begin(),
                {{"distances", bool(first_hits_), first_hits_ ? "where camera rays end" : "nothing ends a ray"},
                 {"backdrops", bool(backdrops_), backdrops_ ? "where they end camera rays" : "there are none"},
                 {"grids", !grids.empty(), grids.empty() ? "no voxel grid" : grids}});
  return stages;
}

bool PreparedMarchGpu::draw(const View& view, const Execution& execution, bool looks, scene::Rendering& result) const {
  const std::size_t pixels = result.film.pixels();
  const char* const names[] = {"airlight", "transmittance", "surface", "mean"};
  frame_.begin(execution);
  const auto layer = [&](const char* name) -> Buffer& { return frame_.buffers.get(name, 12 * pixels); };
  Buffer& totals = frame_.buffers.get("totals", 8 * sizeof(unsigned));
  FilmOnDevice film{nullptr,         nullptr,         nullptr,         layer(names[0]),
                    layer(names[1]), layer(names[2]), layer(names[3]), totals};
  if (first_hits_) {
    film.distances = &frame_.buffers.get("distances", 4 * pixels);
    film.primitives = &frame_.buffers.get("primitives", 4 * pixels);
    frame_.timer.begin("distances");
    first_hits_->find(view, *film.distances, film.primitives);
  }
  if (backdrops_) {
    film.distances = &frame_.buffers.get("distances", 4 * pixels);
    film.seen = &frame_.buffers.get("seen", 12 * pixels);
    frame_.timer.begin("backdrops");
    backdrops_->find(view, *film.distances, bool(first_hits_), *film.seen);
  }
  const bool counts = frame_.download.wants_any();
  if (counts) totals.clear();
  device_->render(view, film, frame_, counts, looks, execution.progress);
  const Buffer* const buffers[] = {&film.airlight, &film.transmittance, &film.surface, &film.mean};
  for (int i = 0; i < 4; ++i) frame_.download.add(names[i], *buffers[i], 12 * pixels);
  frame_.download.add_values("totals", totals, totals.bytes());
  device_->note(frame_.download);
  frame_.finish(result);
  if (device_->unfinished(frame_.download)) return false;
  const std::vector<unsigned> words = frame_.download.values<unsigned>("totals");
  const bool maps = device_->has_maps();  // of which shaders count look-ups
  if (plan_.options.shadow == airlight::ray_marcher::Shadow::map)
    for (const char* counter : {"shadow_rays", "look_ups"}) result.counters[counter] = 0;
  const char* const counters[] = {"steps", maps ? "look_ups" : "shadow_rays", "shadow_steps", "occlusion_rays"};
  for (std::size_t i = 0; 2 * i < words.size(); ++i)
    result.counters[counters[i]] = double(words[2 * i]) + 4294967296.0 * double(words[2 * i + 1]);
  return true;
}

scene::Rendering PreparedMarchGpu::render(const View& view, const Execution& execution) const {
  require_lights_apart(*plan_.scene, view, 1e-9, "ray_marcher_gpu");
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  const Use use(context_);
  if (!device_) {  // no medium, and nothing that shines
    const auto wants = [&](const char* layer) { return !execution.layers || execution.layers->count(layer) != 0; };
    for (const char* name : {"mean", "airlight", "surface", "transmittance"})
      if (wants(name)) result.film.layers[name].assign(3 * result.film.pixels(), name[0] == 't' ? 1.0f : 0.0f);
    result.counters = Traffic().counters();
    for (const char* name : {"steps", "shadow_rays", "shadow_steps", "occlusion_rays"}) result.counters[name] = 0;
    if (plan_.options.shadow == airlight::ray_marcher::Shadow::map) result.counters["look_ups"] = 0;
  } else if (!draw(view, execution, false, result) && !draw(view, execution, true, result)) {
    throw Unavailable("ray_marcher_gpu: " + context_.renderer() + " reports rays as done that are not");
  }
  result.counters["rays"] = double(result.film.pixels());
  result.film.metadata = {{"method", "ray_marcher_gpu"},
                          {"settings", settings_},
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
  for (const std::string& reason : unknown_media(scene.media)) reasons.push_back(reason);
  if (!options.simd) reasons.push_back("kernel = scalar is for the CPU: shaders compute in single precision");
  bool grid = false, negative = false;
  for (const scene::Medium& medium : scene.media)
    scene::match(
        medium.field, [](const scene::Homogeneous&) {},
        [&](const scene::GaussianSum& sum) {
          for (const scene::Gaussian& g : sum.gaussians) negative = negative || g.amplitude < 0;
        },
        [&](const scene::GridPointer&) { grid = true; }, [](const scene::FogmapPointer&) {},
        [](const scene::LegendrePointer&) {}, [&](const scene::FittedPointer&) { grid = true; });
  if (options.shadow == airlight::ray_marcher::Shadow::exact && (grid || negative))
    reasons.push_back(fmt::format("shadow = exact: shaders march the depths of {}",
                                  grid ? "voxel grids" : "Gaussians with negative amplitudes"));
  return reasons;
}

std::unique_ptr<scene::Prepared> RayMarcher::prepare_supported(std::shared_ptr<const Scene> scene,
                                                               const scene::Settings& settings,
                                                               const Execution& execution) const {
  const airlight::ray_marcher::Options options =
      airlight::ray_marcher::read_options(settings, airlight::ray_marcher::length_unit(*scene));
  return std::make_unique<PreparedMarchGpu>(make_plan(std::move(scene), options), settings.canonical(),
                                            scene::read_settings(bind_storage, settings),
                                            scene::read_settings(FirstHits::bind, settings), execution);
}

}  // namespace airlight::gpu::ray_marcher
