#include "methods/wavelet_fog/wavelet_fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "methods/wavelet_fog/leveled_fog.h"
#include "methods/wavelet_fog/sun_scattering.h"
#include "scene/background.h"
#include "scene/error.h"
#include "scene/stopwatch.h"

namespace airlight::wavelet_fog {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedWaveletFog final : public scene::Prepared {
 public:
  PreparedWaveletFog(std::shared_ptr<const Scene> scene, const Options& options, const Execution& execution)
      : scene_(std::move(scene)), options_(options) {
    scene::Stopwatch watch;
    for (const scene::Medium& medium : scene_->media)
      if (extinguishes(medium)) fogs_.emplace_back(medium, options);
    times_.push_back({"maps", watch.lap()});
    if (!sunlit()) return;
    sun_.emplace(*scene_, options, execution);
    times_.push_back({"sun maps", watch.lap()});
  }
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;

 private:
  bool lit() const {
    return scene_->geometry && std::any_of(scene_->lights.begin(), scene_->lights.end(), scene::is_delta);
  }
  bool ambient() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && !fogs_.empty(); }
  bool sunlit() const {
    const auto shines = [](const scene::Light& light) {
      const auto* sun = std::get_if<scene::DirectionalLight>(&light);
      return sun && sun->irradiance.maxCoeff() > 0;
    };
    return options_.sun && !fogs_.empty() && std::any_of(scene_->lights.begin(), scene_->lights.end(), shines);
  }
  bool ends() const { return scene_->geometry || !scene_->lights.empty(); }
  Rgb depth(const Ray&, double length, Visits&, const std::vector<PolarTable>& tables = {}) const;
  Rgb behind(const Ray&, const scene::RayEnd&, Visits&) const;

  std::shared_ptr<const Scene> scene_;
  Options options_;
  std::vector<LeveledFog> fogs_;
  std::optional<SunScattering> sun_;
  std::vector<scene::StageTime> times_;
};

std::vector<scene::Stage> PreparedWaveletFog::stages() const {
  const bool levels = uses_levels(options_.variant);
  std::string maps;
  for (const LeveledFog& fog : fogs_) {
    const scene::Fogmap& map = *std::get<scene::FogmapPointer>(fog.medium().field);
    maps += fmt::format("{}{} x {} of degree {}{}", maps.empty() ? "" : ", ", map.map.range().size[0],
                        map.map.range().size[1], map.map.degree(), map.note.empty() ? "" : " (" + map.note + ")");
  }
  const std::string none = "no fog extinguishes";
  return {{"coarser grids", levels && !fogs_.empty(),
           fogs_.empty() ? none
           : levels      ? fmt::format("{} coarser grids of {}", options_.levels, maps)
                         : "the map itself is read: " + maps},
          {"distances", ends(), ends() ? "where camera rays end" : "nothing ends a ray"},
          {"transmittance", !fogs_.empty(), fogs_.empty() ? none : "one optical depth per pixel and map"},
          {"ambient", ambient(),
           ambient()       ? "ambient_in_scatter times 1 - transmittance"
           : fogs_.empty() ? none
                           : "ambient_in_scatter is zero"},
          {"airlight", sun_.has_value(),
           sun_            ? "directional lights, scattered once"
           : !options_.sun ? "sun is not asked for"
           : fogs_.empty() ? none
                           : "no directional light shines"},
          {"surfaces", lit(), lit() ? "lights through the fog" : "no surface is lit"}};
}

// With tables the ray is one from the eye that they were made for.
Rgb PreparedWaveletFog::depth(const Ray& ray, double length, Visits& visits,
                              const std::vector<PolarTable>& tables) const {
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < fogs_.size(); ++i) {
    const LeveledFog& fog = fogs_[i];
    const double column = std::max(
        0.0, tables.empty() ? fog.column(ray, length, visits)
                            : fog.column(tables[i], ray, length, visits));  // details may leave less than nothing
    for (int c = 0; c < 3; ++c)
      if (fog.medium().sigma_t[c] > 0) sum[c] += fog.medium().sigma_t[c] * column;
  }
  return sum;
}

// What the ray ends on sends back, without the fog in between.
Rgb PreparedWaveletFog::behind(const Ray& ray, const scene::RayEnd& end, Visits& visits) const {
  if (end.on_ball) return Rgb::Zero();
  if (!end.hit) return scene::background(*scene_, ray.direction);
  const scene::Hit& hit = *end.hit;
  const scene::Material& material = scene_->surfaces[hit.surface].material;
  Rgb sum = Rgb::Zero();
  for (const scene::Light& light : scene_->lights) {
    if (!scene::is_delta(light)) continue;
    const scene::Incident in = scene::incident(light, hit.position);
    const double cosine = hit.normal.dot(in.to_light);
    if (!(cosine > 0) || !(in.irradiance.maxCoeff() > 0)) continue;
    const Rgb reflected = scene::brdf(material, hit.normal, in.to_light, -ray.direction) * in.irradiance * cosine;
    if (!(reflected.maxCoeff() > 0)) continue;
    const Point3 start = scene_->geometry->offset_origin(hit.position, hit.normal, in.to_light);
    if (scene_->geometry->occluded({start, in.to_light}, in.distance)) continue;
    sum += reflected * (-depth({hit.position, in.to_light}, in.distance, visits)).exp();
  }
  return sum;
}

scene::Rendering PreparedWaveletFog::render(const View& view, const Execution& execution) const {
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  film.add("mean"), film.add("transmittance"), film.add("surface");
  if (ambient()) film.add("ambient");
  if (sun_) film.add("airlight");
  scene::Stopwatch watch;
  std::vector<PolarTable> tables;
  if (options_.variant == Options::Variant::polar) {
    if (view.camera.kind != scene::Camera::Kind::perspective) throw Error("variant = polar is for perspective cameras");
    for (const LeveledFog& fog : fogs_) tables.push_back(fog.polar_table(view, execution));
    result.times.push_back({"polar tables", watch.lap()});
  }
  std::mutex mutex;
  Visits total;
  SunVisits of_sun;
  for (const PolarTable& table : tables) total.cells += table.cells();
  scene::parallel_rows(view.height, execution, [&](int y) {
    Visits visits, of_surfaces;
    SunVisits sun_visits;
    for (int x = 0; x < view.width; ++x) {
      const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
      const scene::RayEnd end = ends() ? scene::ray_end(*scene_, ray) : scene::RayEnd{};
      const Rgb optical = depth(ray, end.t, visits, tables), clear = (-optical).exp();
      const Rgb surface = clear.maxCoeff() > 0 ? Rgb(clear * behind(ray, end, of_surfaces)) : Rgb(Rgb::Zero());
      Rgb mean = surface;
      film.set("transmittance", x, y, clear);
      film.set("surface", x, y, surface);
      if (ambient()) {
        // Eq. 4; opacity by expm1, since thin fog has a depth of 1e-8.
        const Rgb fog = scene_->ambient_in_scatter * optical.unaryExpr([](double d) { return -std::expm1(-d); });
        film.set("ambient", x, y, fog);
        mean += fog;
      }
      if (sun_) {
        const Rgb scattered = sun_->airlight(ray, end.t, sun_visits);
        film.set("airlight", x, y, scattered);
        mean += scattered;
      }
      film.set("mean", x, y, mean);
    }
    const std::lock_guard lock(mutex);
    total.cells += visits.cells;
    total.coefficients += visits.coefficients;
    of_sun.points += sun_visits.points;
    of_sun.shadow_rays += sun_visits.shadow_rays;
  });
  result.times.push_back({"transmittance", watch.lap()});
  result.counters = {
      {"rays", double(film.pixels())}, {"cells", double(total.cells)}, {"coefficients", double(total.coefficients)}};
  if (sun_) {
    result.counters["sun_points"] = double(of_sun.points);
    result.counters["shadow_rays"] = double(of_sun.shadow_rays);
  }
  return result;
}

}  // namespace

std::string WaveletFog::about() const {
  return "transmittance of fogmaps in B-spline wavelets, constant in-scatter, a sun (Giroud and Biri 2010)";
}

std::vector<scene::SettingSpec> WaveletFog::settings() const { return setting_specs(); }

std::vector<std::string> WaveletFog::supports(const Scene& scene, const scene::Settings& settings) const {
  return reasons_against(scene, read_options(settings));
}

std::unique_ptr<scene::Prepared> WaveletFog::prepare_supported(std::shared_ptr<const Scene> scene,
                                                               const scene::Settings& settings,
                                                               const Execution& execution) const {
  return std::make_unique<PreparedWaveletFog>(std::move(scene), read_options(settings), execution);
}

}  // namespace airlight::wavelet_fog
