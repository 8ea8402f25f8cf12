#include "gpu/fogshop/fogshop_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/buffer.h"
#include "gpu/fogshop/passes.h"
#include "gpu/timer.h"
#include "methods/fogshop/fogshop.h"
#include "methods/fogshop/scattered_reflection.h"
#include "methods/fogshop/stages.h"
#include "scene/error.h"

namespace airlight::gpu {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedFogshopGpu final : public scene::Prepared {
 public:
  PreparedFogshopGpu(std::shared_ptr<const Scene> scene, const fogshop::Options& options)
      : scene_(std::move(scene)),
        model_(fogshop::make_model(*scene_, options)),
        needs_(fogshop::needs_of(*scene_, model_)),
        context_(Context::get()),
        fog_(context_, model_) {
    StageTimer timer(context_);
    if (needs_.light_maps) {
      fog_.fill_light_maps();
      timer.stage("light maps");
    }
    if (needs_.center_depths) {
      fog_.fill_light_depths();
      timer.stage("depths to centres");
    }
    if (needs_.scattered) {
      reflection_ = fogshop::make_reflection(*scene_, options);
      timer.stage("harmonics of the NPSF");
    }
    times_ = timer.times();
  }

  std::vector<scene::Stage> stages() const override {
    auto stages = fogshop::describe_stages(*scene_, model_);
    stages.insert(stages.begin(), {"device", true, context_.description()});
    return stages;
  }
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;

 private:
  std::shared_ptr<const Scene> scene_;
  fogshop::Model model_;
  fogshop::Needs needs_;
  Context& context_;
  mutable FogOnDevice fog_;
  std::unique_ptr<fogshop::ScatteredReflection> reflection_;  // null: left out
  std::vector<scene::StageTime> times_;
};

scene::Rendering PreparedFogshopGpu::render(const View& view, const Execution& execution) const {
  const std::string objection = objection_to_view(*scene_, model_.fog, model_.options, view.camera);
  if (!objection.empty()) throw Error(scene_->name + ": " + objection);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  std::vector<float>&airlight = film.add("airlight"), &surface = film.add("surface"),
  &transmittance = film.add("transmittance"), &mean = film.add("mean");
  const long dispatches = Program::dispatches();
  const Use use(context_);
  StageTimer timer(context_);

  // Section 5.4, step 1: distances, by Embree.
  const std::size_t pixels = film.pixels();
  std::vector<float> distance;
  fogshop::FirstHits hits;
  if (needs_.distances) {
    hits = fogshop::first_hits(*scene_, view, execution);
    for (const double t : hits.distance) distance.push_back(t < far_away ? float(t) : far_away);
    timer.stage("distances");
  }

  if (needs_.airlight) {
    if (needs_.center_depths) {
      fog_.fill_view_depths(view.camera.position);
      timer.stage("depths to centres");
    }
    const std::vector<PixelAirlight> image = fog_.airlight(view, distance, timer);
    for (std::size_t i = 0; i < pixels; ++i)
      for (int c = 0; c < 3; ++c) {
        airlight[3 * i + c] = image[i].airlight[c];
        const double hue = model_.fog.hue[c];
        transmittance[3 * i + c] = hue > 0 ? float(std::exp(-hue * image[i].depth)) : 1.0f;
      }
    timer.stage("read back");
  } else {
    std::fill(transmittance.begin(), transmittance.end(), 1.0f);
  }

  // Steps 4 and 7: L = L_a + e^-T L_p, Eq. 29.
  if (needs_.surfaces) {
    surface_pass(*scene_, model_, reflection_.get(), view, hits.points, transmittance, execution, surface,
                 needs_.scattered ? &film.add("reflected_airlight") : nullptr);
    timer.stage("surfaces");
  }
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = airlight[i] + surface[i];
  result.times = timer.times();
  result.counters["rays"] = double(pixels);
  result.counters["dispatches"] = double(Program::dispatches() - dispatches);
  result.counters["gaussians"] = model_.gaussians.count;
  result.counters["gaussians_dropped"] = model_.dropped;
  return result;
}

}  // namespace

std::string FogshopGpu::about() const {
  return "fogshop in compute shaders, single precision: variants paper and S (Zhou et al. 2007)";
}

std::vector<scene::SettingSpec> FogshopGpu::settings() const { return fogshop::Fogshop().settings(); }

std::vector<std::string> FogshopGpu::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = fogshop::Fogshop().supports(scene, settings);
  const fogshop::Options options = fogshop::read_options(settings);
  if (options.reflectance == fogshop::Options::Reflectance::sun)
    reasons.push_back("reflectance = sun is for the CPU: expected direct, npsf or npsfT");
  if (options.prt) reasons.push_back("prt = true is for the CPU: expected false");
  if (options.table) reasons.push_back("homogeneous = table is for the CPU: shaders evaluate Eq. 17 by quadrature");
  if (options.slices > most_slices)
    reasons.push_back(fmt::format("K = {}: the shader has room for {} slices", options.slices, most_slices));
  if (scene.lights.size() > most_lights)
    reasons.push_back(fmt::format("{} lights: the shader has room for {}", scene.lights.size(), most_lights));
  return reasons;
}

std::unique_ptr<scene::Prepared> FogshopGpu::prepare(std::shared_ptr<const Scene> scene,
                                                     const scene::Settings& settings, const Execution&) const {
  const std::vector<std::string> reasons = supports(*scene, settings);
  if (!reasons.empty())
    throw Error(fmt::format("{}: fogshop_gpu cannot render this: {}", scene->name, reasons.front()));
  return std::make_unique<PreparedFogshopGpu>(std::move(scene), fogshop::read_options(settings));
}

}  // namespace airlight::gpu
