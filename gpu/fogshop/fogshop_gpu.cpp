#include "gpu/fogshop/fogshop_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/buffer.h"
#include "gpu/fogshop/background.h"
#include "gpu/fogshop/passes.h"
#include "gpu/fogshop/surface_shading.h"
#include "gpu/raster_program.h"
#include "gpu/timer.h"
#include "methods/fogshop/fogshop.h"
#include "methods/fogshop/surface_lighting.h"
#include "scene/error.h"
#include "scene/light_on_ray.h"
#include "scene/single_precision.h"

namespace airlight::gpu {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedFogshopGpu final : public scene::Prepared {
 public:
  // `map_side`: texels to a face of the light-distance maps.
  PreparedFogshopGpu(std::shared_ptr<const Scene> scene, const fogshop::Options& options, int map_side,
                     const Execution& execution)
      : scene_(std::move(scene)),
        model_(fogshop::make_model(*scene_, options)),
        plan_(fogshop::make_plan(*scene_, model_)),
        context_(Context::get()),
        fog_(context_, model_),
        map_side_(map_side) {
    if (needs_.distances) first_hits_ = std::make_unique<FirstHits>(context_, *scene_);
    StageTimer timer(context_);
    if (needs_.light_maps) {
      fog_.fill_light_maps();
      timer.stage("light maps");
    }
    if (needs_.center_depths) {
      fog_.fill_light_depths();
      timer.stage("depths to centres");
    }
    if (needs_.f_table) {
      fog_.upload_f_table(fogshop::FTable());
      timer.stage("table of F");
    }
    lighting_ = fogshop::make_lighting(*scene_, options, needs_, execution,
                                       [&](const std::string& stage) { timer.stage(stage); });
    if (needs_.environment_airlight && !needs_.sky_volume) fog_.upload_environment(*lighting_.environment);
    if (needs_.sky_volume) {
      fog_.fill_sky_volume(*scene_);
      timer.stage("sky volume");
    }
    if (needs_.environment) {
      background_ = std::make_unique<Background>(context_, *scene_);
      timer.stage("background");
    }
    if (needs_.surfaces) {
      shading_ = std::make_unique<SurfaceShading>(context_, *scene_, model_, lighting_);
      timer.stage("tables of surfaces");
      if (casts_shadows(*scene_, model_)) {
        shading_->fill_light_distances(map_side);
        timer.stage("light-distance maps");
      }
    }
    times_ = timer.times();
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;

 private:
  std::shared_ptr<const Scene> scene_;
  fogshop::Model model_;
  fogshop::Plan plan_;
  const fogshop::Needs& needs_ = plan_.needs;
  Context& context_;
  mutable FogOnDevice fog_;
  int map_side_;
  fogshop::SurfaceLighting lighting_;
  std::unique_ptr<FirstHits> first_hits_;    // null: rays are infinite
  std::unique_ptr<SurfaceShading> shading_;  // null: left out
  std::unique_ptr<Background> background_;   // the same
  std::vector<scene::StageTime> times_;
};

std::vector<scene::Stage> PreparedFogshopGpu::stages() const {
  auto stages = plan_.stages;
  const bool maps = needs_.surfaces && casts_shadows(*scene_, model_);
  const std::string why_not = scene_->surfaces.empty() ? "there are no surfaces"
                              : model_.lights.empty()  ? "no point light shines"
                                                       : "a lone plane or sphere casts no shadow";
  const std::string why = fmt::format("shadows of surfaces: 6 faces of {0}^2 for each of {1} point light{2}", map_side_,
                                      model_.lights.size(), model_.lights.size() == 1 ? "" : "s");
  const auto surfaces =
      std::find_if(stages.begin(), stages.end(), [](const scene::Stage& stage) { return stage.name == "surfaces"; });
  stages.insert(surfaces, {"light-distance maps", maps, maps ? why : why_not});
  return stages;
}

scene::Rendering PreparedFogshopGpu::render(const View& view, const Execution&) const {
  if (model_.options.source_radius == 0) require_lights_apart(*scene_, view, 1e-9, "fogshop_gpu");
  const std::string objection = objection_to_view(*scene_, model_.fog, model_.options, view.camera);
  if (!objection.empty()) throw Error(scene_->name + ": " + objection);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  const std::size_t pixels = film.pixels();
  const long dispatches = Program::dispatches(), draws = RasterProgram::draws();
  const Use use(context_);
  StageTimer timer(context_);
  const auto layer = [&](const char* name) { return std::make_unique<Buffer>(context_, name, pixels * 12); };

  // Section 5.4, step 1: distances.
  std::unique_ptr<Buffer> distances, low_distances, primitives, image, surface, scattered;
  if (first_hits_) {
    distances = std::make_unique<Buffer>(context_, "distances", pixels * 4);
    if (shading_) primitives = std::make_unique<Buffer>(context_, "primitives", pixels * 4);
    first_hits_->find(view, *distances, primitives.get());
    timer.stage("distances");
    if (needs_.low_resolution) {
      const fogshop::LowResolution low{view.width, view.height, model_.options.downsample};
      low_distances = std::make_unique<Buffer>(context_, "low distances", 4 * low.low_width() * low.low_height());
      first_hits_->find(view, *low_distances, nullptr, {low.factor, 0});
      timer.stage("distances, low resolution");
    }
  }
  if (needs_.airlight) {
    if (needs_.center_depths) {
      fog_.fill_view_depths(view.camera.position);
      timer.stage("depths to centres");
    }
    image = needs_.low_resolution ? fog_.low_resolution_airlight(view, distances.get(), low_distances.get(), timer)
                                  : fog_.airlight(view, distances.get(), timer);
  }
  // Steps 4 and 7: L = L_a + e^-T L_p, Eq. 29.
  if (shading_ || background_) surface = layer("surface");
  if (shading_) {
    if (needs_.scattered) scattered = layer("reflected_airlight");
    shading_->shade(fog_, first_hits_->surfaces(), view, *primitives, image.get(), *surface, scattered.get());
    timer.stage("surfaces");
  }
  if (background_) {
    background_->draw(fog_, view, distances.get(), image.get(), *surface);
    timer.stage("background");
  }
  if (image || surface) {
    const auto airlight = layer("airlight"), transmittance = layer("transmittance"), mean = layer("mean");
    fog_.compose(image.get(), surface.get(), *airlight, *transmittance, *mean);
    timer.stage("composition");
    film.layers["airlight"] = airlight->download<float>();
    film.layers["transmittance"] = transmittance->download<float>();
    film.layers["mean"] = mean->download<float>();
  } else {  // no medium, and nothing that shines
    film.add("airlight");
    film.add("mean");
    film.layers["transmittance"].assign(3 * pixels, 1.0f);
  }
  if (surface) film.layers["surface"] = surface->download<float>();
  // The mark of surfaces.comp. How long rays through the tree of surfaces take nobody knows before.
  if (shading_ &&
      std::any_of(film.layers["surface"].begin(), film.layers["surface"].end(), [](float v) { return v < 0; }))
    throw Unavailable(fmt::format(
        "gpu: shadow rays take more loop iterations than {} allows: fewer lights or a coarser mesh expected",
        context_.renderer()));
  film.add("surface");
  if (scattered) film.layers["reflected_airlight"] = scattered->download<float>();
  timer.stage("read back");
  result.times = timer.times();
  if (!plan_.doubt.empty()) film.metadata["warning"] = "fogshop_gpu: " + plan_.doubt;
  result.counters["rays"] = double(pixels);
  result.counters["dispatches"] = double(Program::dispatches() - dispatches);
  result.counters["draws"] = double(RasterProgram::draws() - draws);
  result.counters["gaussians"] = model_.gaussians.count;
  result.counters["gaussians_dropped"] = model_.dropped;
  return result;
}

}  // namespace

std::string FogshopGpu::about() const {
  return "fogshop in compute shaders, single precision: variants paper and S (Zhou et al. 2007)";
}

std::vector<scene::SettingSpec> FogshopGpu::settings() const {
  auto settings = fogshop::Fogshop().settings();
  settings.push_back(
      scene::integer_setting("light_distance_side", "512", 1, 8192,
                             "texels to a side of a light-distance map's six faces; shadows are exact whatever it is"));
  return settings;
}

std::vector<std::string> FogshopGpu::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = fogshop::Fogshop().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  const fogshop::Options options = fogshop::read_options(settings);
  if (options.slices > most_slices)
    reasons.push_back(fmt::format("K = {}: the shader has room for {} slices", options.slices, most_slices));
  if (scene.lights.size() > most_lights)
    reasons.push_back(fmt::format("{} lights: the shader has room for {}", scene.lights.size(), most_lights));
  return reasons;
}

std::unique_ptr<scene::Prepared> FogshopGpu::prepare_supported(std::shared_ptr<const Scene> scene,
                                                               const scene::Settings& settings,
                                                               const Execution& execution) const {
  return std::make_unique<PreparedFogshopGpu>(std::move(scene), fogshop::read_options(settings),
                                              int(settings.integer("light_distance_side")), execution);
}

}  // namespace airlight::gpu
