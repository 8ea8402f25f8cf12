#include "gpu/wavelet_fog/wavelet_fog.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/film_layers.h"
#include "gpu/raster/backdrops.h"
#include "gpu/wavelet_fog/sun_scattering.h"
#include "gpu/wavelet_fog/surface_light.h"
#include "methods/wavelet_fog/compression.h"
#include "methods/wavelet_fog/sun_scattering.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/single_precision.h"

namespace airlight::gpu::wavelet_fog {
namespace {

using airlight::wavelet_fog::Options;
using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedWaveletFogGpu final : public scene::Prepared {
 public:
  PreparedWaveletFogGpu(std::shared_ptr<const Scene>, const Options&, FirstHits::Way);

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  bool ambient() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && !fogs_.empty(); }
  bool polar() const { return options_.variant == Options::Variant::polar && !fogs_.empty(); }
  void find_depths(const View&, const Buffer* distances, const Buffer& depths, const Buffer& counters) const;
  void find_ends(const View&, const Buffer*& distances, const Buffer*& primitives, const Buffer*& seen) const;
  void compose(const View&, const Buffer& depths, const Buffer& lit, const Buffer* seen) const;
  scene::Rendering draw(const View&, const Execution&, std::vector<unsigned>& counters) const;
  std::vector<unsigned> finish(scene::Rendering&) const;

  std::shared_ptr<const Scene> scene_;  // with maps as `keep` and `degree` ask for
  std::vector<airlight::wavelet_fog::CompressionReport> compression_;
  Options options_;
  Context& context_;
  std::vector<std::unique_ptr<FogOnDevice>> fogs_;
  std::unique_ptr<FirstHits> first_hits_;  // null: no surface and no ball ends rays
  std::unique_ptr<Backdrops> backdrops_;   // null: there are none
  std::unique_ptr<SurfaceLight> surfaces_;
  std::unique_ptr<SunOnDevice> sun_;  // null: no sun is asked for, or none shines
  Program* composition_ = nullptr;
  mutable Frame frame_;
  std::vector<scene::StageTime> times_;
};

PreparedWaveletFogGpu::PreparedWaveletFogGpu(std::shared_ptr<const Scene> scene, const Options& options,
                                             FirstHits::Way way)
    : options_(options), context_(Context::get()), frame_(context_) {
  const Use use(context_);
  StageTimer timer(context_);
  if (options_.keep < 1) timer.begin("compression");
  scene_ = with_maps_changed(std::move(scene), options_, &compression_);
  timer.begin("upload");
  if (something_ends_rays(*scene_)) first_hits_ = std::make_unique<FirstHits>(context_, *scene_, true, way);
  if (!scene_->backdrops.empty()) backdrops_ = std::make_unique<Backdrops>(context_, *scene_);
  surfaces_ = std::make_unique<SurfaceLight>(context_, *scene_, first_hits_.get());
  for (const scene::Medium& medium : scene_->media)
    if (extinguishes(medium))
      fogs_.push_back(
          std::make_unique<FogOnDevice>(context_, medium, options_, int(fogs_.size()), lamps_light_surfaces(*scene_)));
  if (options_.sun && airlight::wavelet_fog::why_no_sun(*scene_).empty())
    sun_ = std::make_unique<SunOnDevice>(context_, *scene_, fogs_, first_hits_.get(), options_);
  composition_ = &program(context_, "composition", 64);
  timer.begin("maps");
  for (const auto& fog : fogs_) fog->refresh();
  if (sun_) sun_->refresh();
  times_ = timer.times();
}

std::vector<scene::Stage> PreparedWaveletFogGpu::stages() const {
  const bool levels = airlight::wavelet_fog::uses_levels(options_.variant) && !fogs_.empty(), lit = surfaces_->shines();
  const std::string none = "no fog extinguishes";
  return {{"coarser grids", levels,
           fogs_.empty() ? none
           : levels ? fmt::format("{} coarser grids, made on the device when the map is another one", options_.levels)
                    : "the map itself is read"},
          {"distances", first_hits_ != nullptr, first_hits_ ? "where camera rays end" : "nothing ends a ray"},
          {"polar tables", polar(), polar() ? "integrals from the eye, in every frame" : "rays walk through cells"},
          {"transmittance", !fogs_.empty(), fogs_.empty() ? none : "one dispatch per map"},
          {"airlight", sun_ != nullptr,
           sun_            ? "directional lights, scattered once"
           : !options_.sun ? "sun is not asked for"
                           : airlight::wavelet_fog::why_no_sun(*scene_)},
          {"surfaces", lit,
           lit ? "lamps through the fog, the environment" : "no surface is lit, and there is no environment"},
          {"composition", true, "layers of the film"}};
}

// Lamps and their balls may move, maps become others of the same size. Backdrops belong to a camera.
std::optional<std::vector<scene::StageTime>> PreparedWaveletFogGpu::next(std::shared_ptr<const Scene> given,
                                                                         const Execution&) {
  if (!airlight::wavelet_fog::unsupported(*given, options_).empty()) return std::nullopt;
  std::vector<airlight::wavelet_fog::CompressionReport> compression;
  scene::Stopwatch watch;
  const std::shared_ptr<const Scene> scene = with_maps_changed(std::move(given), options_, &compression);
  std::vector<scene::StageTime> times;
  if (options_.keep < 1) times.push_back({"compression", watch.lap()});
  const auto same_light = [](const scene::Light& a, const scene::Light& b) {
    const auto *x = std::get_if<scene::EnvironmentLight>(&a), *y = std::get_if<scene::EnvironmentLight>(&b);
    if (!x || !y) return a.index() == b.index();
    return x->map == y->map && (x->scale == y->scale).all() && x->to_map == y->to_map && x->sh.empty() && y->sh.empty();
  };
  if (!same_surfaces(*scene, *scene_) || scene->lights.size() != scene_->lights.size() ||
      scene->media.size() != scene_->media.size() || backdrops_ || !scene->backdrops.empty() ||
      !std::equal(scene->lights.begin(), scene->lights.end(), scene_->lights.begin(), same_light) ||
      lamps_light_surfaces(*scene) != lamps_light_surfaces(*scene_) ||
      (options_.sun &&
       airlight::wavelet_fog::why_no_sun(*scene).empty() != airlight::wavelet_fog::why_no_sun(*scene_).empty()))
    return std::nullopt;
  std::vector<const scene::Medium*> media;
  for (std::size_t i = 0; i < scene->media.size(); ++i) {
    if (extinguishes(scene->media[i]) != extinguishes(scene_->media[i])) return std::nullopt;
    if (extinguishes(scene->media[i])) media.push_back(&scene->media[i]);
  }
  for (std::size_t i = 0; i < media.size(); ++i)
    if (!fogs_[i]->fits(*media[i])) return std::nullopt;
  const Use use(context_);
  if (first_hits_ && !first_hits_->move_balls(*scene)) return std::nullopt;
  for (std::size_t i = 0; i < media.size(); ++i) fogs_[i]->become(*media[i]);
  if (sun_) sun_->write();
  scene_ = scene;
  compression_ = std::move(compression);
  return times;
}

void PreparedWaveletFogGpu::find_depths(const View& view, const Buffer* distances, const Buffer& depths,
                                        const Buffer& counters) const {
  const bool counts = frame_.download.wants_any();
  if (polar()) {
    frame_.timer.begin("polar tables");
    for (const auto& fog : fogs_) fog->fill_table(view, frame_.buffers, counters, counts);
  }
  if (fogs_.empty()) return;
  frame_.timer.begin("transmittance");
  for (const auto& fog : fogs_) fog->add_depths(view, distances, depths, counters, fog == fogs_.front(), counts);
}

// Distances of what ends camera rays and its primitives; what backdrops send. Null: nothing does, there are none.
void PreparedWaveletFogGpu::find_ends(const View& view, const Buffer*& distances, const Buffer*& primitives,
                                      const Buffer*& seen) const {
  if (!first_hits_ && !backdrops_) return;
  const std::size_t pixels = std::size_t(view.width) * view.height;
  distances = &frame_.buffers.get("distances", 4 * pixels);
  frame_.timer.begin("distances");
  if (first_hits_) {
    primitives = &frame_.buffers.get("primitives", 4 * pixels);
    first_hits_->find(view, *distances, primitives);
  }
  if (!backdrops_) return;
  seen = &frame_.buffers.get("seen", 12 * pixels);
  backdrops_->find(view, *distances, bool(first_hits_), *seen, primitives);
}

void PreparedWaveletFogGpu::compose(const View& view, const Buffer& depths, const Buffer& lit,
                                    const Buffer* seen) const {
  const std::size_t pixels = std::size_t(view.width) * view.height;
  Program& p = *composition_;
  bind_film_layers(frame_, pixels, p,
                   {at::mean_layer, at::transmittance_layer, at::surface_layer, at::airlight_layer, at::ambient_layer},
                   {sun_ != nullptr, ambient() ? std::optional(scene_->ambient_in_scatter) : std::nullopt});
  depths.bind(at::depths);
  lit.bind(at::lit);
  (seen ? *seen : depths).bind(at::seen);
  p.set("pixels", int(pixels));
  p.set("has_fog", !fogs_.empty());
  p.set("has_lit", surfaces_->shines());
  p.set("has_seen", seen != nullptr);
  p.dispatch(int(pixels));
}

// The words of the counters, none where no layer is wanted.
std::vector<unsigned> PreparedWaveletFogGpu::finish(scene::Rendering& result) const {
  frame_.finish(result);
  result.counters["rays"] = double(result.film.pixels());
  for (const airlight::wavelet_fog::CompressionReport& report : compression_) {
    result.counters["kept"] += double(report.kept);
    result.counters["map_error_ppm"] = std::max(result.counters["map_error_ppm"], 1e6 * report.error);
  }
  std::vector<unsigned> words = frame_.download.values<unsigned>("counters");
  if (words.empty()) return words;
  result.counters["cells"] = words[0] + 4294967296.0 * words[1];
  result.counters["coefficients"] = words[2] + 4294967296.0 * words[3];
  if (polar()) result.counters["lookups"] = words[7] + 4294967296.0 * words[8];
  if (sun_) {
    result.counters["sun_points"] = words[5] + 4294967296.0 * words[6];
    result.counters["shadow_rays"] = words[10] + 4294967296.0 * words[11];
  }
  if (words[4] != 0)
    throw Unavailable(fmt::format("gpu: {} ends the loops of a ray after 65535 iterations, too few for this map",
                                  context_.renderer()));
  return words;
}

scene::Rendering PreparedWaveletFogGpu::render(const View& view, const Execution& execution) const {
  if (polar() && view.camera.kind != scene::Camera::Kind::perspective)
    throw Error("variant = polar is for perspective cameras");
  const Use use(context_);
  while (true) {
    std::vector<unsigned> counters;
    scene::Rendering result = draw(view, execution, counters);
    if (!sun_ || counters.empty() || !sun_->left_rays(counters)) return result;
  }
}

scene::Rendering PreparedWaveletFogGpu::draw(const View& view, const Execution& execution,
                                             std::vector<unsigned>& words) const {
  const std::size_t pixels = std::size_t(view.width) * view.height;
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  frame_.begin(execution);
  Buffer& counters = frame_.buffers.get("counters", 4 * counter_words);
  if (frame_.download.wants_any()) counters.clear();
  const Buffer& depths = frame_.buffers.get("depths", 16 * pixels);
  const Buffer& lit = frame_.buffers.get("lit", surfaces_->shines() ? sizeof(LitData) * pixels : sizeof(LitData));
  const Buffer *distances = nullptr, *primitives = nullptr, *seen = nullptr;
  if (std::any_of(fogs_.begin(), fogs_.end(), [](const auto& fog) { return fog->stale(); })) {
    frame_.timer.begin("maps");
    for (const auto& fog : fogs_)
      if (fog->stale()) fog->refresh();
    if (sun_) sun_->refresh();
  }
  find_ends(view, distances, primitives, seen);
  find_depths(view, distances, depths, counters);
  if (sun_) {
    frame_.timer.begin("airlight");
    sun_->render(*scene_, view, frame_.buffers, distances, frame_.buffers.get("airlight", 12 * pixels), counters,
                 frame_.download.wants_any());
  }
  if (surfaces_->shines()) {
    frame_.timer.begin("surfaces");
    surfaces_->render(*scene_, view, primitives, lit, [&](const scene::Light& light) {
      for (const auto& fog : fogs_) {
        set_lamp(fog->light_rays(), light);
        fog->dim(view, lit);
      }
    });
  }
  frame_.timer.begin("composition");
  compose(view, depths, lit, seen);
  frame_.download.add_values("counters", counters, 4 * counter_words);
  words = finish(result);
  return result;
}

}  // namespace

std::string WaveletFog::about() const {
  return "wavelet_fog in compute shaders: fogmaps and their coarser grids in single precision (Giroud and Biri 2010)";
}

std::vector<scene::SettingSpec> WaveletFog::settings() const {
  std::vector<scene::SettingSpec> settings = airlight::wavelet_fog::WaveletFog().settings();
  settings.push_back(scene::list_settings(FirstHits::bind).front());
  return settings;
}

std::vector<std::string> WaveletFog::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::wavelet_fog::WaveletFog().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  return reasons;
}

std::unique_ptr<scene::Prepared> WaveletFog::prepare_supported(std::shared_ptr<const Scene> scene,
                                                               const scene::Settings& settings,
                                                               const Execution&) const {
  return std::make_unique<PreparedWaveletFogGpu>(std::move(scene), airlight::wavelet_fog::read_options(settings),
                                                 scene::read_settings(FirstHits::bind, settings));
}

}  // namespace airlight::gpu::wavelet_fog
