#include "methods/fogshop/fogshop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/fogshop/airlight_pass.h"
#include "methods/fogshop/domain.h"
#include "methods/fogshop/low_resolution.h"
#include "methods/fogshop/surface_lighting.h"
#include "methods/fogshop/surface_pass.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/light/background.h"

namespace airlight::fogshop {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedFogshop final : public scene::Prepared {
 public:
  PreparedFogshop(std::shared_ptr<const Scene> scene, const Options& options, const Execution& execution)
      : options_(options) {
    times_ = prepare(std::move(scene), execution);
  }
  std::vector<scene::Stage> stages() const override { return plan_.stages; }
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  std::vector<scene::StageTime> prepare(std::shared_ptr<const Scene>, const Execution&);
  AirlightImage find_airlight(const View&, const ViewModel&, const std::vector<double>& distance, const Execution&,
                              scene::Rendering&) const;
  void count(double rays, double evaluations, std::map<std::string, double>& counters) const;

  std::shared_ptr<const Scene> scene_;
  Options options_;  // as they were asked for; the model's may do without maps
  Model model_;
  Plan plan_;
  SurfaceLighting lighting_;
  std::vector<scene::StageTime> times_;
  int maps_made_ = 0;  // for this frame; others are of frames before
};

// For a first frame, or one that keeps what the frame before has in common with it.
std::vector<scene::StageTime> PreparedFogshop::prepare(std::shared_ptr<const Scene> scene, const Execution& execution) {
  std::vector<scene::StageTime> times;
  scene::Stopwatch watch;
  Model model = make_model(*scene, options_);
  const Options& options = model.options;
  Plan plan = make_plan(*scene, model);
  const Needs& needs = plan.needs;
  const Unchanged same = scene_ ? unchanged(*scene_, model_, *scene, model) : Unchanged{};
  const double seconds = watch.lap();
  if (model.gaussians.count > 0) times.push_back({"gaussians", seconds});
  int depths_made = 0, maps_made = 0;
  for (LightModel& light : model.lights) {
    const LightModel* before = same.gaussians ? light_at(model_, light.position) : nullptr;
    if (needs.center_depths) {
      if (before && same.fog && !before->center_depth.empty()) {
        light.center_depth = before->center_depth;
      } else {
        light.center_depth = depths_to_centers(model, light.position, execution, model.evaluations);
        ++depths_made;
      }
    }
    if (needs.light_maps) {
      if (before && before->map) {
        light.map = before->map;
      } else {
        light.map = std::make_shared<LightMap>(model.gaussians, light.position, options.map_directions,
                                               options.map_edges, options.erf, execution);
        model.evaluations += light.map->evaluations();
        ++maps_made;
      }
    }
  }
  if (depths_made > 0) times.push_back({"depths to centres", watch.lap()});
  if (maps_made > 0) times.push_back({"light maps", watch.lap()});
  if (needs.f_table) {
    model.f_table = model_.f_table;
    if (!model.f_table) {
      model.f_table = std::make_shared<FTable>();
      times.push_back({"table of F", watch.lap()});
    }
  }
  SurfaceLighting lighting =
      make_lighting(*scene, model, needs, lighting_, same, execution, [&](const std::string& stage) {
        times.push_back({stage, watch.lap()});
      });
  if (needs.sky_volume) {
    if (same.fog && same.surfaces && same.environments) model.sky = model_.sky;
    if (!model.sky) {
      model.sky = std::make_shared<SkyVolume>(*scene, model.fog, model.gaussians, options.erf, options.sky_cells,
                                              options.sky_directions, execution);
      model.evaluations += model.sky->evaluations();
      times.push_back({"sky volume", watch.lap()});
    }
  }
  scene_ = std::move(scene);
  model_ = std::move(model);
  plan_ = std::move(plan);
  lighting_ = std::move(lighting);
  maps_made_ = maps_made;
  return times;
}

// The airlight, and what the medium lets through, into layers of a film.
void write_layers(const AirlightImage& image, const Fog& fog, std::vector<float>& airlight,
                  std::vector<float>& transmittance) {
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    const Rgb visible = (-image.depth[i] * fog.extinction_ratio).exp();
    for (int c = 0; c < 3; ++c) {
      airlight[3 * i + c] = float(image.airlight[i][c]);
      transmittance[3 * i + c] = fog.extinction_ratio[c] > 0 ? float(visible[c]) : 1.0f;
    }
  }
}

// Airlight of every pixel, directly or interpolated from the pixels of a low resolution.
AirlightImage PreparedFogshop::find_airlight(const View& view, const ViewModel& view_model,
                                             const std::vector<double>& distance, const Execution& execution,
                                             scene::Rendering& result) const {
  const Needs& needs = plan_.needs;
  const std::vector<double> ends = needs.environment ? up_to_environment(model_.options, distance) : distance;
  AirlightImage image = needs.low_resolution
                            ? low_resolution_airlight(*scene_, model_, view_model, view, ends, needs.distances,
                                                      execution, result.times, result.counters)
                            : airlight_pass(model_, view_model, view, ends, execution);
  result.counters["gaussians_crossed"] = image.crossed;
  result.counters["gaussians_in_tiles"] = image.candidates;
  return image;
}

void PreparedFogshop::count(double rays, double evaluations, std::map<std::string, double>& counters) const {
  counters["rays"] = rays;
  counters["erf_evaluations"] = evaluations;
  counters["erf_evaluations_prepare"] = model_.evaluations;
  if (plan_.needs.light_maps) counters["light_maps_made"] = maps_made_;
  counters["gaussians"] = model_.gaussians.count;
  counters["gaussians_dropped"] = model_.dropped;
  if (lighting_.depths) counters["average_depth_cells"] = double(lighting_.depths->cells().size());
}

scene::Rendering PreparedFogshop::render(const View& view, const Execution& execution) const {
  require_own_camera(*scene_, view);
  const std::string objection = unsupported_view(*scene_, model_.fog, model_.options, view.camera);
  if (!objection.empty()) throw Error(scene_->name + ": " + objection);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  std::vector<float>&airlight = film.add("airlight"), &surface = film.add("surface"),
  &transmittance = film.add("transmittance"), &mean = film.add("mean");
  scene::Stopwatch watch;
  double evaluations = 0;

  // Section 5.4, step 1: distances.
  const std::size_t pixels = film.pixels();
  const Needs& needs = plan_.needs;
  FirstHits hits{std::vector<double>(pixels, infinity), {}, {}};
  if (needs.distances) {
    hits = first_hits(*scene_, view, execution);
    result.times.push_back({"distances", watch.lap()});
  }

  // Step 5: T(v,b_i) and T(s,v).
  const ViewModel view_model = make_view_model(model_, view.camera.position, execution, evaluations);
  if (needs.center_depths) result.times.push_back({"depths to centres", watch.lap()});

  // Step 6: airlight and T(v,p).
  std::vector<double> depth(pixels, 0.0);
  if (needs.airlight) {
    const AirlightImage image = find_airlight(view, view_model, hits.distance, execution, result);
    write_layers(image, model_.fog, airlight, transmittance);
    depth = image.depth;
    evaluations += image.evaluations;
    const double seconds = watch.lap();
    if (!needs.low_resolution) result.times.push_back({"airlight", seconds});
  } else {
    std::fill(transmittance.begin(), transmittance.end(), 1.0f);
  }

  // Steps 4 and 7: L = L_a + e^-T L_p, Eq. 29.
  if (needs.surfaces) {
    evaluations += surface_pass(*scene_, model_, lighting_, view, hits.points, transmittance, execution, surface,
                                needs.scattered ? &film.add("reflected_airlight") : nullptr);
    result.times.push_back({"surfaces", watch.lap()});
  }
  if (needs.environment) {
    const bool by_psf = needs.environment_airlight && !needs.sky_volume;
    environment_pass(*scene_, model_, by_psf ? lighting_.environment.get() : nullptr, view, hits.distance, depth,
                     execution, airlight, surface);
    result.times.push_back({"environment", watch.lap()});
  }
  for (std::size_t i = 0; i < hits.seen.size(); ++i)
    if (!std::isnan(hits.seen[i])) surface[i] = transmittance[i] * hits.seen[i];
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = airlight[i] + surface[i];
  if (!plan_.doubt.empty()) film.metadata["warning"] = "fogshop: " + plan_.doubt;
  count(double(pixels), evaluations, result.counters);
  return result;
}

std::optional<std::vector<scene::StageTime>> PreparedFogshop::next(std::shared_ptr<const Scene> scene,
                                                                   const Execution& execution) {
  if (!unsupported(*scene, options_).empty()) return std::nullopt;
  if (!camera_alone_moved(*scene_, *scene)) return prepare(std::move(scene), execution);
  scene_ = std::move(scene);
  plan_ = make_plan(*scene_, model_);
  maps_made_ = 0;
  model_.evaluations = 0;
  return std::vector<scene::StageTime>{};
}

}  // namespace

std::string Fogshop::about() const {
  return "airlight of a sum of Gaussians in closed form (Zhou et al. 2007), and by slices with exact depths";
}

std::vector<scene::SettingSpec> Fogshop::settings() const { return setting_specs(); }

std::vector<std::string> Fogshop::supports(const Scene& scene, const scene::Settings& settings) const {
  return unsupported(scene, read_options(settings));
}

std::vector<std::string> unsupported(const Scene& scene, const Options& options) {
  std::vector<std::string> reasons = unsupported_media(scene.media);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const std::string why = scene::unknown_light<scene::PointLight, scene::EnvironmentLight>(scene.lights, i);
        !why.empty())
      reasons.push_back(why);
  if (options.sky_volume() && reasons.empty() && make_fog(scene.media).sum.constant > 0)
    reasons.push_back("environment_airlight = volume is for Gaussians alone, and the medium has a constant");
  if (options.sky_volume() && options.noise_scale > 0 && options.variant == Options::Variant::paper)
    reasons.push_back("variant = paper bends depths by noise and not places: environment_airlight = volume needs S");
  if (options.table && options.source_radius > 0)
    reasons.push_back("the table of F has no softened form: homogeneous = table needs source_radius = 0");
  if (options.variant == Options::Variant::slices && options.extrapolate && options.slices % 2 != 0)
    reasons.push_back(fmt::format("K = {} is odd: extrapolation needs an even number of slices", options.slices));
  const auto points = std::count_if(scene.lights.begin(), scene.lights.end(),
                                    [](const auto& l) { return std::holds_alternative<scene::PointLight>(l); });
  const double side = options.map_directions + 2, entries = double(points) * side * side * (options.map_edges + 1);
  if (options.variant != Options::Variant::paper && options.map && entries > 1 << 28)
    reasons.push_back(
        fmt::format("map_directions = {} and map_edges = {} ask for {} light maps of {:.1f} GB in all, at most 1",
                    options.map_directions, options.map_edges, points, entries * sizeof(float) / 1e9));
  for (const std::string& reason : objections_to_surfaces(scene, options)) reasons.push_back(reason);
  if (reasons.empty()) {
    const Fog fog = make_fog(scene.media);
    if (const std::string objection = objection_to_domain(scene, fog, options); !objection.empty())
      reasons.push_back(objection);
    if (!fog.one_albedo() && options.reflectance != Options::Reflectance::direct)
      reasons.push_back("the media differ in albedo, and Eq. 25 has one: reflectance = direct leaves it out");
    if (!fog.one_albedo() && has_environment(scene))
      reasons.push_back("the media differ in albedo, and Eq. 28 has one: expected point lights only");
    if (fog.g != 0 && (options.reflectance != Options::Reflectance::direct || has_environment(scene)))
      reasons.push_back(
          "phase function hg: NPSF is that of isotropic scattering, expected reflectance = direct and point lights only");
    const std::string objection = unsupported_view(scene, fog, options, scene.camera);
    if (!objection.empty()) reasons.push_back(objection);
  }
  return reasons;
}

std::unique_ptr<scene::Prepared> Fogshop::prepare_supported(std::shared_ptr<const Scene> scene,
                                                            const scene::Settings& settings,
                                                            const Execution& execution) const {
  return std::make_unique<PreparedFogshop>(std::move(scene), read_options(settings), execution);
}

}  // namespace airlight::fogshop
