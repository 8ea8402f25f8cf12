#include "methods/wavelet_fog/wavelet_fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "methods/wavelet_fog/compression.h"
#include "methods/wavelet_fog/leveled_fog.h"
#include "methods/wavelet_fog/sun_scattering.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/light/scattered_lights.h"
#include "scene/picture.h"

namespace airlight::wavelet_fog {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

struct Cover {
  Rgb transmittance, opacity;
};
// Transmittance and opacity of depths >= 0, with one exponential per channel, or one for equal channels. The smaller of
// the two is exact to all digits, since thin fog has an opacity of 1e-8.
Cover cover_of(const Rgb& depth) {
  Cover cover;
  for (int c = 0; c < 3; ++c) {
    double &clear = cover.transmittance[c], &dense = cover.opacity[c];
    if (c > 0 && depth[c] == depth[c - 1]) {
      clear = cover.transmittance[c - 1];
      dense = cover.opacity[c - 1];
    } else if (depth[c] < 0.6) {
      dense = -std::expm1(-depth[c]);
      clear = 1 - dense;
    } else {
      clear = std::exp(-depth[c]);
      dense = 1 - clear;
    }
  }
  return cover;
}

struct Work {
  Visits visits;
  SunVisits of_sun;
  void operator+=(const Work& more) {
    visits.cells += more.visits.cells;
    visits.coefficients += more.visits.coefficients;
    visits.lookups += more.visits.lookups;
    of_sun.points += more.of_sun.points;
    of_sun.shadow_rays += more.of_sun.shadow_rays;
  }
};

class PreparedWaveletFog final : public scene::Prepared {
 public:
  PreparedWaveletFog(std::shared_ptr<const Scene> scene, const Options& options, const Execution& execution)
      : options_(options) {
    times_ = prepare(std::move(scene), {}, execution);
  }
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  std::vector<scene::StageTime> prepare(std::shared_ptr<const Scene>, std::vector<LeveledFog> known, const Execution&);
  bool lit() const {
    const auto reaches = [](const scene::Light& light) { return scene::is_delta(light) && scene::shines(light); };
    return scene_->geometry && std::any_of(scene_->lights.begin(), scene_->lights.end(), reaches);
  }
  bool ambient() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && !fogs_.empty(); }
  bool sunlit() const { return options_.sun && why_no_sun(*scene_).empty(); }
  bool ends() const { return scene_->geometry || !scene_->lights.empty() || !scene_->backdrops.empty(); }
  Rgb depth(const Ray&, double length, Visits&, const std::vector<PolarTable>& tables = {}) const;
  scene::Pixel pixel(const Ray&, const std::vector<PolarTable>&, Work&) const;

  std::shared_ptr<const Scene> scene_;
  Options options_;
  std::vector<LeveledFog> fogs_;
  std::optional<SunScattering> sun_;
  std::vector<CompressionReport> compression_;
  std::vector<scene::StageTime> times_;
};

// For a scene, from what is known of the same media before.
std::vector<scene::StageTime> PreparedWaveletFog::prepare(std::shared_ptr<const Scene> scene,
                                                          std::vector<LeveledFog> known, const Execution& execution) {
  std::vector<scene::StageTime> times;
  scene::Stopwatch watch;
  compression_.clear();
  const std::shared_ptr<const Scene> before = std::move(scene_);  // whose maps are compared
  scene_ = with_maps_changed(std::move(scene), options_, &compression_);
  if (options_.keep < 1) times.push_back({"compression", watch.lap()});
  fogs_.clear();
  for (const scene::Medium& medium : scene_->media) {
    if (!extinguishes(medium)) continue;
    if (fogs_.size() < known.size()) {
      fogs_.push_back(std::move(known[fogs_.size()]));
      fogs_.back().become(medium);
    } else {
      fogs_.emplace_back(medium, options_);
    }
  }
  times.push_back({"maps", watch.lap()});
  const std::optional<SunScattering> sun_before = std::exchange(sun_, std::nullopt);
  if (!sunlit()) return times;
  sun_.emplace(*scene_, options_, execution, sun_before ? &*sun_before : nullptr);
  const double seconds = watch.lap();
  if (sun_->maps_made() > 0) times.push_back({"sun maps", seconds});
  return times;
}

std::optional<std::vector<scene::StageTime>> PreparedWaveletFog::next(std::shared_ptr<const Scene> scene,
                                                                      const Execution& execution) {
  if (!unsupported(*scene, options_).empty()) return std::nullopt;
  return prepare(std::move(scene), std::exchange(fogs_, {}), execution);
}

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
                           : why_no_sun(*scene_)},
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

scene::Pixel PreparedWaveletFog::pixel(const Ray& ray, const std::vector<PolarTable>& tables, Work& work) const {
  scene::Pixel pixel;
  const scene::RayEnd end = ends() ? scene::camera_end(*scene_, ray) : scene::RayEnd{};
  const Cover cover = cover_of(depth(ray, end.t, work.visits, tables));
  pixel.transmittance = cover.transmittance;
  if (ends() && cover.transmittance.maxCoeff() > 0)
    pixel.surface =
        cover.transmittance *
        scene::end_radiance(*scene_, ray, end, scene_->lights, [&](const scene::Incident& in, std::size_t) -> Rgb {
          Visits of_surfaces;  // not counted
          return (-depth({end.hit->position, in.to_light}, in.distance, of_surfaces)).exp();
        });
  if (ambient()) pixel.ambient = scene_->ambient_in_scatter * cover.opacity;  // eq. 4
  if (sun_) pixel.airlight = sun_->airlight(ray, end.t, work.of_sun);
  return pixel;
}

scene::Rendering PreparedWaveletFog::render(const View& view, const Execution& execution) const {
  require_own_camera(*scene_, view);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  const scene::PictureLayers layers(film, {.airlight = sun_.has_value(), .ambient = ambient()});
  scene::Stopwatch watch;
  std::vector<PolarTable> tables;
  if (options_.variant == Options::Variant::polar) {
    if (view.camera.kind != scene::Camera::Kind::perspective) throw Error("variant = polar is for perspective cameras");
    for (const LeveledFog& fog : fogs_) tables.push_back(fog.polar_table(view, execution));
    result.times.push_back({"polar tables", watch.lap()});
  }
  Work work = scene::draw_pixels<Work>(view, execution, layers,
                                       [&](const Ray& ray, Work& of_row) { return pixel(ray, tables, of_row); });
  for (const PolarTable& table : tables) work.visits.cells += table.cells();
  result.times.push_back({fogs_.empty() ? "camera rays" : "transmittance", watch.lap()});
  result.counters = {{"rays", double(film.pixels())},
                     {"cells", double(work.visits.cells)},
                     {"coefficients", double(work.visits.coefficients)}};
  if (!tables.empty()) result.counters["lookups"] = double(work.visits.lookups);
  if (sun_) {
    result.counters["sun_points"] = double(work.of_sun.points);
    result.counters["shadow_rays"] = double(work.of_sun.shadow_rays);
    result.counters["sun_maps_made"] = sun_->maps_made();
  }
  if (options_.keep < 1) {
    for (const CompressionReport& report : compression_) {
      result.counters["kept"] += double(report.kept);
      result.counters["map_error_ppm"] = std::max(result.counters["map_error_ppm"], 1e6 * report.error);
    }
  }
  return result;
}

}  // namespace

std::string WaveletFog::about() const {
  return "transmittance of fogmaps in B-spline wavelets, constant in-scatter, a sun (Giroud and Biri 2010)";
}

std::vector<scene::SettingSpec> WaveletFog::settings() const { return setting_specs(); }

std::vector<std::string> WaveletFog::supports(const Scene& scene, const scene::Settings& settings) const {
  return unsupported(scene, read_options(settings));
}

std::unique_ptr<scene::Prepared> WaveletFog::prepare_supported(std::shared_ptr<const Scene> scene,
                                                               const scene::Settings& settings,
                                                               const Execution& execution) const {
  return std::make_unique<PreparedWaveletFog>(std::move(scene), read_options(settings), execution);
}

}  // namespace airlight::wavelet_fog
