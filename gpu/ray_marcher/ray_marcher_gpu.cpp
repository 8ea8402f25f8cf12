#include "gpu/ray_marcher/ray_marcher_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "gpu/ray_marcher/device_plan.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "reference/ray_marcher/scalar.h"
#include "reference/ray_marcher/stages.h"
#include "scene/background.h"
#include "scene/error.h"

namespace airlight::gpu {
namespace {

using ray_marcher::Plan;
using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedMarchGpu final : public scene::Prepared {
 public:
  PreparedMarchGpu(Plan plan, std::string settings)
      : plan_(std::move(plan)), settings_(std::move(settings)), context_(Context::get()) {
    StageTimer timer(context_);
    if (!plan_.layers.empty()) device_ = std::make_unique<PlanOnDevice>(context_, plan_);
    timer.stage("upload");
    times_ = timer.times();
  }

  std::vector<scene::Stage> stages() const override {
    std::vector<scene::Stage> stages = describe_stages(plan_);
    stages.insert(stages.begin(), {"device", true, context_.description()});
    return stages;
  }
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;

 private:
  void shade_behind(const View&, const Execution&, const std::vector<scene::RayEnd>&, const std::vector<float>&,
                    std::vector<float>& surface, ray_marcher::Counters&) const;

  Plan plan_;
  std::string settings_;
  Context& context_;
  std::unique_ptr<PlanOnDevice> device_;  // null: no medium with extinction
  std::vector<scene::StageTime> times_;
};

// Where rays end on surfaces and lights' balls, by Embree; empty where nothing can end one.
std::vector<scene::RayEnd> ray_ends(const Scene& scene, const View& view, const Execution& execution) {
  std::vector<scene::RayEnd> ends;
  const bool balls = std::any_of(scene.lights.begin(), scene.lights.end(), [](const auto& light) {
    const auto ball = scene::ball(light);
    return ball && ball->radius > 0;
  });
  if (!scene.geometry && !balls) return ends;
  ends.resize(std::size_t(view.width) * view.height);
  scene::parallel_rows(view.height, {execution.threads, {}}, [&](int y) {
    for (int x = 0; x < view.width; ++x)
      ends[std::size_t(y) * view.width + x] =
          ray_end(scene, camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height));
  });
  return ends;
}

// What surfaces reflect, and the environment, through the media.
void PreparedMarchGpu::shade_behind(const View& view, const Execution& execution,
                                    const std::vector<scene::RayEnd>& ends, const std::vector<float>& transmittance,
                                    std::vector<float>& surface, ray_marcher::Counters& total) const {
  std::mutex mutex;
  scene::parallel_rows(view.height, {execution.threads, {}}, [&](int y) {
    ray_marcher::Counters counters;
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t(y) * view.width + x;
      const Rgb through(transmittance[3 * i], transmittance[3 * i + 1], transmittance[3 * i + 2]);
      const scene::RayEnd end = ends.empty() ? scene::RayEnd{} : ends[i];
      if ((through == 0).all() || end.on_ball) continue;
      const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
      const Rgb behind = through * (end.hit ? lit_surface(plan_, *end.hit, ray.direction, counters)
                                            : scene::background(*plan_.scene, ray.direction));
      for (int c = 0; c < 3; ++c) surface[3 * i + c] = float(behind[c]);
    }
    const std::lock_guard lock(mutex);
    total.add(counters);
  });
}

scene::Rendering PreparedMarchGpu::render(const View& view, const Execution& execution) const {
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  std::vector<float>&mean = film.add("mean"), &airlight = film.add("airlight"), &surface = film.add("surface"),
  &transmittance = film.add("transmittance");
  film.metadata = {{"method", "ray_marcher_gpu"},
                   {"settings", settings_},
                   {"scene", plan_.scene->name},
                   {"hash", plan_.scene->hash}};
  const long dispatches = Program::dispatches();
  const Use use(context_);
  StageTimer timer(context_);
  ray_marcher::Counters counters;
  counters.rays = static_cast<long long>(film.pixels());

  const std::vector<scene::RayEnd> ends = ray_ends(*plan_.scene, view, execution);
  if (!ends.empty()) timer.stage("distances");
  std::fill(transmittance.begin(), transmittance.end(), 1.0f);
  if (device_) {
    std::vector<double> distance;
    for (const scene::RayEnd& end : ends) distance.push_back(end.t);
    const std::vector<MarchedPixel> image = device_->march(view, distance, execution, timer);
    for (std::size_t i = 0; i < image.size(); ++i) {
      std::copy_n(image[i].airlight.data(), 3, airlight.data() + 3 * i);
      std::copy_n(image[i].transmittance.data(), 3, transmittance.data() + 3 * i);
      counters.steps += image[i].steps;
      counters.shadow_rays += image[i].shadow_rays;
      counters.shadow_steps += image[i].shadow_steps;
      counters.occlusion_rays += image[i].occlusion_rays;
    }
  }
  if ((plan_.scene->geometry && !plan_.lights.empty()) || has_environment(*plan_.scene)) {
    shade_behind(view, execution, ends, transmittance, surface, counters);
    timer.stage("surfaces");
  }
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = airlight[i] + surface[i];
  result.times = timer.times();
  result.counters = {{"rays", double(counters.rays)},
                     {"steps", double(counters.steps)},
                     {"shadow_rays", double(counters.shadow_rays)},
                     {"shadow_steps", double(counters.shadow_steps)},
                     {"occlusion_rays", double(counters.occlusion_rays)},
                     {"dispatches", double(Program::dispatches() - dispatches)}};
  return result;
}

}  // namespace

std::string RayMarcherGpu::about() const {
  return "brute-force single scattering in compute shaders, the steps of ray_marcher in single precision";
}

std::vector<scene::SettingSpec> RayMarcherGpu::settings() const { return ray_marcher::option_specs(); }

std::vector<std::string> RayMarcherGpu::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = ray_marcher::RayMarcher().supports(scene, settings);
  const ray_marcher::Options options = ray_marcher::read_options(settings, 1);
  if (!options.simd) reasons.push_back("kernel = scalar is for the CPU: shaders compute in single precision");
  bool grid = false, negative = false;
  for (const scene::Medium& medium : scene.media) {
    if (const auto* sum = std::get_if<scene::GaussianSum>(&medium.field))
      negative = negative || std::any_of(sum->gaussians.begin(), sum->gaussians.end(),
                                         [](const scene::Gaussian& g) { return g.amplitude < 0; });
    else
      grid = grid || !std::holds_alternative<scene::Homogeneous>(medium.field);
  }
  if (options.exact_shadow && (grid || negative))
    reasons.push_back(fmt::format("shadow = exact: shaders march the depths of {}",
                                  grid ? "voxel grids" : "Gaussians with negative amplitudes"));
  return reasons;
}

std::unique_ptr<scene::Prepared> RayMarcherGpu::prepare(std::shared_ptr<const Scene> scene,
                                                        const scene::Settings& settings, const Execution&) const {
  const std::vector<std::string> reasons = supports(*scene, settings);
  if (!reasons.empty()) throw Error(fmt::format("ray_marcher_gpu: {}", reasons.front()));
  const ray_marcher::Options options = ray_marcher::read_options(settings, ray_marcher::length_unit(*scene));
  return std::make_unique<PreparedMarchGpu>(make_plan(std::move(scene), options), settings.canonical());
}

}  // namespace airlight::gpu
