#include "reference/ray_marcher/ray_marcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reference/ray_marcher/light_maps.h"
#include "reference/ray_marcher/limits.h"
#include "reference/ray_marcher/plan.h"
#include "reference/ray_marcher/scalar.h"
#include "reference/ray_marcher/stages.h"
#include "reference/ray_marcher/tile.h"
#include "scene/base/error.h"
#include "scene/base/flush_subnormals.h"
#include "scene/base/place_error.h"
#include "scene/base/stopwatch.h"
#include "scene/light/light_on_ray.h"
#include "scene/picture.h"

namespace airlight::ray_marcher {
namespace {

// The integral of 1/t^2 along every camera ray diverges there; steps would make any number of it.
bool light_on_camera(const scene::Scene& scene) {
  if (scene.camera.kind != scene::Camera::Kind::perspective) return false;
  for (const scene::Light& light : scene.lights)
    if (const auto ball = scene::ball(light); ball && ball->radius == 0 && ball->center == scene.camera.position)
      for (const scene::Medium& m : scene.media)
        if ((m.albedo * m.sigma_t).maxCoeff() * scene::density(m, ball->center) > 0) return true;
  return false;
}

// The wall clock, shared among the stages that are kept as the threads' time was; what it costs to find that another
// has nothing to do goes to the first. The plain path does not tell stages apart.
std::vector<scene::StageTime> stage_times(const std::vector<scene::Stage>& stages, const Counters& c, double seconds) {
  const std::map<std::string, double> threads = {
      {"camera_rays", c.ray_seconds}, {"camera_march", c.march_seconds},    {"occlusion", c.occlusion_seconds},
      {"shadows", c.shadow_seconds},  {"scattering", c.scattering_seconds}, {"surfaces", c.surface_seconds}};
  double sum = 0, rest = seconds;
  for (const auto& [name, t] : threads) sum += t;
  std::vector<scene::StageTime> times = {{"camera_rays", 0}};
  for (const scene::Stage& stage : stages) {
    const auto found = threads.find(stage.name);
    if (!stage.kept || found == threads.end() || stage.name == "camera_rays" || sum == 0) continue;
    times.push_back({stage.name, seconds * found->second / sum});
    rest -= times.back().seconds;
  }
  times[0].seconds = rest;
  return times;
}

class PreparedMarch final : public scene::Prepared {
 public:
  PreparedMarch(std::shared_ptr<const scene::Scene> scene, const scene::Settings& settings,
                const scene::Execution& execution)
      : settings_(settings) {
    prepare(std::move(scene), execution);
  }

  std::vector<scene::Stage> stages() const override { return stages_; }
  std::vector<scene::StageTime> prepare_times() const override {
    std::vector<scene::StageTime> times = {{"prepare", prepare_seconds_ - plan_.map_seconds}};
    if (plan_.map_seconds > 0) times.push_back({"light_maps", plan_.map_seconds});
    return times;
  }

  // Keeps the layers of media and the maps of lights that still hold.
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const scene::Scene> scene,
                                                    const scene::Execution& execution) override {
    if (!RayMarcher().supports(*scene, settings_).empty()) return std::nullopt;
    prepare(std::move(scene), execution);
    return prepare_times();
  }

  scene::Rendering render(const scene::View& view, const scene::Execution& execution) const override {
    require_own_camera(*plan_.scene, view);
    require_lights_apart(*plan_.scene, view, 1e-13, "ray_marcher");
    scene::Rendering result;
    result.film = scene::Film(view.width, view.height);
    const scene::PictureLayers layers(result.film, {});
    result.film.metadata = {{"method", "ray_marcher"},
                            {"settings", settings_.canonical()},
                            {"scene", plan_.scene->name},
                            {"hash", plan_.scene->hash}};
    scene::Stopwatch watch;
    // Steps of this many are in memory at once, a quarter of a kilobyte each.
    const auto rays_at_once =
        std::size_t(std::clamp(double(1 << 18) / steps_per_ray(*plan_.scene, plan_.options), 1.0, 64.0));
    const int columns = (view.width + tile_side - 1) / tile_side, rows = (view.height + tile_side - 1) / tile_side;
    const auto total = scene::parallel_sum<Counters>(columns * rows, execution, [&](int tile, Counters& counters) {
      const int x0 = tile % columns * tile_side, y0 = tile / columns * tile_side;
      const int x1 = std::min(x0 + tile_side, view.width), y1 = std::min(y0 + tile_side, view.height);
      const scene::FlushSubnormals flush;
      static thread_local std::vector<Ray> rays;
      static thread_local TileMarcher marcher;
      rays.clear();
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
          rays.push_back(camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height));
      const std::vector<Pixel> pixels =
          plan_.options.simd ? marcher.march_in_parts(plan_, rays, rays_at_once, counters) : plain(rays, counters);
      for (int i = 0; i < int(pixels.size()); ++i)
        layers.put(x0 + i % (x1 - x0), y0 + i / (x1 - x0), pixels[std::size_t(i)]);
    });
    const double seconds = watch.lap();
    result.times = stage_times(stages_, total, seconds);
    result.counters = {{"rays", double(total.rays)},
                       {"steps", double(total.steps)},
                       {"shadow_rays", double(total.shadow_rays)},
                       {"shadow_steps", double(total.shadow_steps)},
                       {"occlusion_rays", double(total.occlusion_rays)}};
    if (plan_.options.shadow == Shadow::map) {
      result.counters["look_ups"] = double(total.look_ups);
      result.counters["light_maps_made"] = plan_.maps_made;
    }
    result.film.metadata["seconds"] = fmt::format("{:.6f}", seconds);
    std::string& counters = result.film.metadata["counters"];
    for (const auto& [name, value] : result.counters)
      counters += fmt::format("{}{}={:.0f}", counters.empty() ? "" : " ", name, value);
    return result;
  }

 private:
  void prepare(std::shared_ptr<const scene::Scene> scene, const scene::Execution& execution) {
    scene::Stopwatch watch;
    const Options options = read_options(settings_, length_unit(*scene));
    const Plan* before = plan_.scene ? &plan_ : nullptr;
    Plan plan = make_plan(std::move(scene), options, before);
    make_light_maps(plan, execution, before);
    prepare_seconds_ = watch.lap();
    plan_ = std::move(plan);
    stages_ = describe_stages(plan_);
  }

  std::vector<Pixel> plain(const std::vector<Ray>& rays, Counters& counters) const {
    std::vector<Pixel> pixels;
    for (const Ray& ray : rays) pixels.push_back(march_ray(plan_, ray, counters));
    return pixels;
  }

  static constexpr int tile_side = 8;
  Plan plan_;
  std::vector<scene::Stage> stages_;  // once: the default's stated error asks a grid for its greatest value
  scene::Settings settings_;
  double prepare_seconds_ = 0;
};

}  // namespace

std::string RayMarcher::about() const {
  return "brute-force single scattering: camera steps times shadow steps, any medium (reference/ray_marcher/README.md)";
}

std::vector<scene::SettingSpec> RayMarcher::settings() const { return option_specs(); }

std::vector<std::string> RayMarcher::supports(const scene::Scene& scene, const scene::Settings& settings) const {
  const double unit = length_unit(scene);
  std::vector<std::string> reasons = unsupported(scene, read_options(settings, unit), unit);
  const auto visible = std::count_if(scene.media.begin(), scene.media.end(), scene::extinguishes);
  if (visible > std::ptrdiff_t(most_layers))
    reasons.push_back(fmt::format("{} media with extinction, at most {} are supported", visible, most_layers));
  if (const std::string reason = scene::too_thick(scene, 0.01); !reason.empty()) reasons.push_back(reason);
  if (light_on_camera(scene))
    reasons.push_back(
        "a point or spot light of radius 0 stands on the camera inside a medium: its airlight is infinite; expected a "
        "distance or a radius");
  // Its depths are 32-bit floats, and so are the squares of what it steps over: as far as 1 over the extinction.
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const scene::Medium& m = scene.media[i];
    const double extinction = m.sigma_t.maxCoeff() * homogeneous_density(m.field).value_or(0);
    if (extinction > 0 && extinction < 1e-12 && std::holds_alternative<scene::Unbounded>(m.region))
      reasons.push_back(
          fmt::format("medium {} has no bounds and an extinction of {:.3g} 1/m: expected a region, or 1e-12 "
                      "1/m or more",
                      i, extinction));
  }
  return reasons;
}

std::unique_ptr<scene::Prepared> RayMarcher::prepare_supported(std::shared_ptr<const scene::Scene> scene,
                                                               const scene::Settings& settings,
                                                               const scene::Execution& execution) const {
  return std::make_unique<PreparedMarch>(std::move(scene), settings, execution);
}

}  // namespace airlight::ray_marcher
