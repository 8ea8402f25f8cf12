#include "gpu/ray_marcher/ray_marcher_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "gpu/raster/first_hits.h"
#include "gpu/raster/pixel_ends.h"
#include "gpu/raster_program.h"
#include "gpu/ray_marcher/device_plan.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "reference/ray_marcher/scalar.h"
#include "reference/ray_marcher/stages.h"
#include "scene/background.h"
#include "scene/error.h"
#include "scene/light_on_ray.h"
#include "scene/single_precision.h"

namespace airlight::gpu {
namespace {

using ray_marcher::Plan;
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
  PreparedMarchGpu(Plan plan, std::string settings, GridStorage storage)
      : plan_(std::move(plan)), settings_(std::move(settings)), context_(Context::get()) {
    StageTimer timer(context_);
    if (!plan_.layers.empty()) device_ = std::make_unique<PlanOnDevice>(context_, plan_, storage);
    if (something_ends_rays(*plan_.scene)) first_hits_ = std::make_unique<FirstHits>(context_, *plan_.scene);
    timer.stage("upload");
    times_ = timer.times();
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;

 private:
  void shade_behind(const View&, const Execution&, const std::vector<int>& primitives,
                    const std::vector<float>& distances, const std::vector<float>& transmittance,
                    std::vector<float>& surface, ray_marcher::Counters&) const;

  Plan plan_;
  std::string settings_;
  Context& context_;
  std::unique_ptr<PlanOnDevice> device_;   // null: no medium with extinction
  std::unique_ptr<FirstHits> first_hits_;  // null: rays are infinite
  std::vector<scene::StageTime> times_;
};

std::vector<scene::Stage> PreparedMarchGpu::stages() const {
  std::vector<scene::Stage> stages = describe_stages(plan_);
  const std::string grids = device_ ? device_->grids().description() : "";
  stages.insert(stages.begin(), {{"distances", bool(first_hits_),
                                  first_hits_ ? "where camera rays end, by a tree of boxes" : "nothing ends a ray"},
                                 {"grids", !grids.empty(), grids.empty() ? "no voxel grid" : grids}});
  return stages;
}

// What surfaces reflect, and the environment, through the media.
void PreparedMarchGpu::shade_behind(const View& view, const Execution& execution, const std::vector<int>& primitives,
                                    const std::vector<float>& distances, const std::vector<float>& transmittance,
                                    std::vector<float>& surface, ray_marcher::Counters& total) const {
  std::mutex mutex;
  const PixelEnds ends(*plan_.scene);
  scene::parallel_rows(view.height, {execution.threads, {}}, [&](int y) {
    ray_marcher::Counters counters;
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t(y) * view.width + x;
      const Rgb through(transmittance[3 * i], transmittance[3 * i + 1], transmittance[3 * i + 2]);
      if ((through == 0).all()) continue;
      const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
      const scene::RayEnd end = primitives.empty() ? scene::RayEnd{} : ends.at(primitives[i], distances[i], ray);
      if (end.on_ball) continue;
      const Rgb behind = through * (end.hit ? lit_surface(plan_, *end.hit, ray.direction, counters)
                                            : scene::background(*plan_.scene, ray.direction));
      for (int c = 0; c < 3; ++c) surface[3 * i + c] = float(behind[c]);
    }
    const std::lock_guard lock(mutex);
    total.add(counters);
  });
}

scene::Rendering PreparedMarchGpu::render(const View& view, const Execution& execution) const {
  require_lights_apart(*plan_.scene, view, 1e-9, "ray_marcher_gpu");
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  std::vector<float>&mean = film.add("mean"), &airlight = film.add("airlight"), &surface = film.add("surface"),
  &transmittance = film.add("transmittance");
  film.metadata = {{"method", "ray_marcher_gpu"},
                   {"settings", settings_},
                   {"scene", plan_.scene->name},
                   {"hash", plan_.scene->hash}};
  const long dispatches = Program::dispatches(), draws = RasterProgram::draws();
  const Use use(context_);
  StageTimer timer(context_);
  ray_marcher::Counters counters;
  counters.rays = static_cast<long long>(film.pixels());

  std::unique_ptr<Buffer> distances, primitives;
  if (first_hits_) {
    distances = std::make_unique<Buffer>(context_, "distances", film.pixels() * 4);
    primitives = std::make_unique<Buffer>(context_, "primitives", film.pixels() * 4);
    first_hits_->find(view, *distances, primitives.get());
    timer.stage("distances");
  }
  std::fill(transmittance.begin(), transmittance.end(), 1.0f);
  if (device_) {
    const std::vector<MarchedPixel> image = device_->march(view, distances.get(), execution, timer);
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
    shade_behind(view, execution, primitives ? primitives->download<int>() : std::vector<int>{},
                 distances ? distances->download<float>() : std::vector<float>{}, transmittance, surface, counters);
    timer.stage("surfaces");
  }
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = airlight[i] + surface[i];
  result.times = timer.times();
  result.counters = {{"rays", double(counters.rays)},
                     {"steps", double(counters.steps)},
                     {"shadow_rays", double(counters.shadow_rays)},
                     {"shadow_steps", double(counters.shadow_steps)},
                     {"occlusion_rays", double(counters.occlusion_rays)},
                     {"dispatches", double(Program::dispatches() - dispatches)},
                     {"draws", double(RasterProgram::draws() - draws)}};
  return result;
}

}  // namespace

std::string RayMarcherGpu::about() const {
  return "brute-force single scattering in compute shaders, the steps of ray_marcher in single precision";
}

std::vector<scene::SettingSpec> RayMarcherGpu::settings() const {
  auto settings = ray_marcher::option_specs();
  settings.push_back(scene::choice_setting(
      "grid_storage", "auto", {"auto", "buffer", "texture"},
      "voxel grids on the device; auto: textures, on a software renderer a buffer while one is enough"));
  return settings;
}

std::vector<std::string> RayMarcherGpu::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = ray_marcher::RayMarcher().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  const ray_marcher::Options options = ray_marcher::read_options(settings, 1);
  if (!options.simd) reasons.push_back("kernel = scalar is for the CPU: shaders compute in single precision");
  bool grid = false, negative = false;
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const std::string why =
        scene::unknown_field<scene::Homogeneous, scene::GaussianSum, scene::GridPointer>(scene.media, i);
    if (!why.empty()) reasons.push_back(why);
    scene::match(
        scene.media[i].field, [](const scene::Homogeneous&) {},
        [&](const scene::GaussianSum& sum) {
          for (const scene::Gaussian& g : sum.gaussians) negative = negative || g.amplitude < 0;
        },
        [&](const scene::GridPointer&) { grid = true; });
  }
  if (options.exact_shadow && (grid || negative))
    reasons.push_back(fmt::format("shadow = exact: shaders march the depths of {}",
                                  grid ? "voxel grids" : "Gaussians with negative amplitudes"));
  return reasons;
}

std::unique_ptr<scene::Prepared> RayMarcherGpu::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                  const scene::Settings& settings,
                                                                  const Execution&) const {
  const ray_marcher::Options options = ray_marcher::read_options(settings, ray_marcher::length_unit(*scene));
  const std::string& storage = settings.text("grid_storage");
  return std::make_unique<PreparedMarchGpu>(make_plan(std::move(scene), options), settings.canonical(),
                                            storage == "buffer"    ? GridStorage::buffer
                                            : storage == "texture" ? GridStorage::texture
                                                                   : GridStorage::automatic);
}

}  // namespace airlight::gpu
