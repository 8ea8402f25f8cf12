#include "gpu/shadow_planes/shadow_planes.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/frame.h"
#include "gpu/shadow_planes/shading.h"
#include "gpu/shadow_planes/surface_count.h"
#include "methods/shadow_planes/paper_stages.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "scene/base/error.h"
#include "scene/light/light_on_ray.h"
#include "scene/light/scattered_lights.h"
#include "scene/single_precision.h"

namespace airlight::gpu::shadow_planes {
namespace {

using airlight::shadow_planes::Options;
using scene::Execution;
using scene::Scene;
using scene::View;

constexpr int most_degree = 16;  // single precision

std::vector<std::string> unsupported_on_device(const Scene& scene, const Options& options) {
  std::vector<std::string> reasons = airlight::shadow_planes::unsupported(scene, options);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  if (options.evaluator == Options::Evaluator::polynomial && options.degree > most_degree)
    reasons.push_back(fmt::format("degree = {}: single precision takes {} at most", options.degree, most_degree));
  if (scene.media.size() > most_media)
    reasons.push_back(fmt::format("{} media: a uniform block holds {}", scene.media.size(), most_media));
  return reasons;
}

class PreparedShadowPlanesGpu final : public scene::Prepared {
 public:
  PreparedShadowPlanesGpu(std::shared_ptr<const Scene>, const Options&, FirstHits::Way);

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  struct OfSurfaces {                       // what depends on them
    std::unique_ptr<FirstHits> first_hits;  // everything that depends on surfaces
    std::unique_ptr<PlaneShading> shading;
    std::shared_ptr<const airlight::shadow_planes::Occluders> occluders;  // null: nothing casts a shadow
    std::unique_ptr<Silhouettes> silhouettes;                             // null: nothing casts a shadow
    std::unique_ptr<OriginCounts> counts;                                 // null: nothing casts a shadow
    std::unique_ptr<FanOnDevice> fan;                                     // null: nothing casts a shadow
    std::unique_ptr<VertexValues> values;   // null: the airlight is computed for every pixel
    mutable std::vector<LightEdges> edges;  // by light
    mutable int rounds = 0;                 // PlaneShading::add; more when a frame that was looked at had too few
    const SurfacesOnDevice* on_device() const { return first_hits ? &first_hits->surfaces() : nullptr; }
  };
  std::vector<scene::StageTime> prepare();
  void find_silhouettes() const;  // of every light
  int shaded_airs() const { return int(scene_->lights.size()) * std::max(1, airlight_terms_.count()); }

  void draw(const View&) const;  // a frame, up to the notes of what is downloaded
  void add_light(int light, LitPicture&) const;
  bool finish(scene::Rendering&) const;  // false: crossings are missing, more rounds would have them

  std::shared_ptr<const Scene> scene_;
  Options options_;
  Context& context_;
  AirlightTermsOnDevice airlight_terms_;
  FirstHits::Way way_;
  OfSurfaces of_;
  mutable bool moved_ = false;  // lights are no longer where of_.edges has them
  int terms_made_ = 0;          // for this frame; others are of frames before
  mutable int silhouettes_made_ = 0;
  mutable Frame frame_;
  std::vector<scene::StageTime> times_;
};

PreparedShadowPlanesGpu::PreparedShadowPlanesGpu(std::shared_ptr<const Scene> scene, const Options& options,
                                                 FirstHits::Way way)
    : scene_(std::move(scene)),
      options_(options),
      context_(Context::get()),
      airlight_terms_(context_, scene_, options),
      way_(way),
      terms_made_(airlight_terms_.count()),
      frame_(context_) {
  times_ = prepare();
}

// Prepares everything that depends on the surfaces. Meshes that have not moved keep the edges of the previous frame.
std::vector<scene::StageTime> PreparedShadowPlanesGpu::prepare() {
  OfSurfaces now;
  const bool lit = std::any_of(scene_->lights.begin(), scene_->lights.end(), scene::shines);
  const bool surfaces = !scene_->surfaces.empty();
  const bool balls = std::any_of(scene_->lights.begin(), scene_->lights.end(),
                                 [](const scene::Light& light) { return scene::ball(light)->radius > 0; });
  StageTimer timer(context_);
  if (surfaces || balls) {
    timer.begin("upload");
    now.first_hits = std::make_unique<FirstHits>(context_, *scene_, true, way_);
  }
  now.shading = std::make_unique<PlaneShading>(context_, scene_, options_, airlight_terms_, now.on_device());
  if (lit && surfaces) {
    timer.begin("edges");
    now.occluders = std::make_shared<const airlight::shadow_planes::Occluders>(scene_, of_.occluders.get());
    now.silhouettes = std::make_unique<Silhouettes>(context_, *now.occluders, VertexValues::plane_rows(options_));
    now.counts = std::make_unique<OriginCounts>(context_, *now.silhouettes, *now.first_hits);
    now.fan = std::make_unique<FanOnDevice>(context_, now.silhouettes->most());
    now.edges.resize(scene_->lights.size());
    // A ray crosses an edge once, the border of what a sphere hides five times at most.
    int most = now.silhouettes->most();
    for (const scene::Surface& surface : scene_->surfaces)
      if (std::holds_alternative<scene::Sphere>(surface.shape)) most += 5;
    now.rounds = std::min(2, (most - 1) / now.shading->crossings_of_dispatch());
  }
  if (options_.evaluation == Options::Evaluation::vertices && scene::why_nothing_scatters(*scene_).empty())
    now.values = std::make_unique<VertexValues>(context_, scene_, options_, airlight_terms_, now.on_device(),
                                                now.silhouettes ? now.silhouettes->most() : 0);
  of_ = std::move(now);
  if (of_.silhouettes) {
    timer.begin("silhouettes");
    find_silhouettes();
  }
  return timer.times();
}

void PreparedShadowPlanesGpu::find_silhouettes() const {
  for (std::size_t l = 0; l < scene_->lights.size(); ++l)
    if (scene::shines(scene_->lights[l])) {
      of_.silhouettes->find(scene::ball(scene_->lights[l])->center, of_.edges[l]);
      silhouettes_made_ += int(of_.occluders->meshes().size());
    }
  moved_ = false;
}

std::vector<scene::Stage> PreparedShadowPlanesGpu::stages() const {
  std::size_t edges = 0;
  const Use use(context_);
  for (const LightEdges& of_light : of_.edges)
    if (of_light.state) edges += std::size_t(of_light.state->download<int>()[offsetof(LightStateData, edge_count) / 4]);
  const auto lights = std::size_t(std::count_if(scene_->lights.begin(), scene_->lights.end(), scene::shines));
  const std::string clear = scene::why_nothing_scatters(*scene_);
  const std::string found = of_.silhouettes ? airlight::shadow_planes::silhouettes_found(edges, lights)
                            : lights > 0    ? "there are no surfaces"
                                            : "no light shines";
  const bool surfaces = lights > 0 && !scene_->surfaces.empty();
  return {
      {"silhouettes", of_.silhouettes != nullptr, found},
      {"counts", of_.silhouettes != nullptr, of_.silhouettes ? "surfaces between light and camera, by a tree" : found},
      {"edges of rays", of_.silhouettes != nullptr,
       of_.silhouettes ? "by angle around the line from light to camera" : found},
      {"airlight", clear.empty(), clear.empty() ? "one dispatch per light and air" : clear},
      {"surfaces", surfaces,
       scene_->surfaces.empty() ? "there are none"
       : surfaces               ? "with the first air of a light"
                                : "no light shines"},
      {"composition", true, "layers of the film"}};
}

// Silhouettes are found when the frame is drawn: that waits once.
std::optional<std::vector<scene::StageTime>> PreparedShadowPlanesGpu::next(std::shared_ptr<const Scene> scene,
                                                                           const Execution&) {
  if (scene->surfaces.size() != scene_->surfaces.size() || scene->lights.size() != scene_->lights.size() ||
      !unsupported_on_device(*scene, options_).empty() ||
      !airlight::shadow_planes::same_media(scene->media, scene_->media))
    return std::nullopt;
  for (std::size_t l = 0; l < scene->lights.size(); ++l)
    if (scene::shines(scene->lights[l]) != scene::shines(scene_->lights[l]) ||
        scene::scatter(scene->media, scene->lights[l]) != scene::scatter(scene_->media, scene_->lights[l]))
      return std::nullopt;
  const Use use(context_);
  const bool casters = scene->geometry != scene_->geometry;
  if (!casters && of_.first_hits && !of_.first_hits->move_balls(*scene)) return std::nullopt;
  const std::shared_ptr<const Scene> before = std::exchange(scene_, std::move(scene));
  terms_made_ = silhouettes_made_ = 0;
  if (casters) {
    try {
      return prepare();
    } catch (...) {
      scene_ = before;  // what of_ is of
      throw;
    }
  }
  for (std::size_t l = 0; of_.silhouettes && l < scene_->lights.size(); ++l)
    moved_ = moved_ || scene::ball(scene_->lights[l])->center != scene::ball(before->lights[l])->center;
  return std::vector<scene::StageTime>{};
}

void PreparedShadowPlanesGpu::add_light(int l, LitPicture& picture) const {
  if (!scene::shines(scene_->lights[std::size_t(l)])) return;
  const bool scattered = scene::scatter(scene_->media, scene_->lights[std::size_t(l)]);
  if (!scattered && scene_->surfaces.empty()) return;
  const Point3 light = scene::ball(scene_->lights[l])->center;
  const scene::Camera& camera = picture.view.camera;
  PlaneShading::Edges lists;
  if (of_.silhouettes) {
    frame_.timer.begin("counts");
    of_.counts->find(picture.view, light, of_.edges[l], picture.states, picture.counters);
    frame_.timer.begin("edges of rays");
    of_.fan->fill(camera, light, of_.edges[l]);
    lists = {&of_.edges[l], of_.fan.get()};
  }
  if (!scattered) {
    frame_.timer.begin("airlight and surfaces");
    of_.shading->add(picture, l, -1, lists, nullptr, of_.rounds);
    return;
  }
  for (int term = 0; term < airlight_terms_.count(); ++term) {
    if (of_.values) {
      const bool planes = lists.edges && options_.shadows != Options::Shadows::none;
      const double far = lists.edges ? airlight::shadow_planes::mesh_reach(*scene_, airlight_terms_.region(term), light,
                                                                           camera.position, options_.plane_levels)
                                     : 0;
      of_.values->fill(frame_, l, term, camera.position, planes ? lists.edges : nullptr, far, picture.counters);
    }
    frame_.timer.begin("airlight and surfaces");
    of_.shading->add(picture, l, term, lists, of_.values.get(), of_.rounds);
  }
}

void PreparedShadowPlanesGpu::draw(const View& view) const {
  if (moved_) {
    frame_.timer.begin("silhouettes");
    find_silhouettes();
  }
  LitPicture picture(frame_, view, of_.first_hits != nullptr, of_.silhouettes != nullptr, shaded_airs() * of_.rounds);
  if (of_.first_hits) {
    frame_.timer.begin("distances");
    of_.first_hits->find(view, *picture.distances, picture.primitives);
  }
  for (std::size_t l = 0; l < scene_->lights.size(); ++l) add_light(int(l), picture);
  frame_.timer.begin("composition");
  const bool fogged = std::any_of(scene_->media.begin(), scene_->media.end(), scene::extinguishes);
  const bool ambient = options_.ambient && fogged && scene_->ambient_in_scatter.maxCoeff() > 0;
  of_.shading->compose(picture, frame_, ambient ? std::optional(scene_->ambient_in_scatter) : std::nullopt);
  frame_.download.add_values("counters", picture.counters, sizeof(CountersData));
  for (std::size_t l = 0; l < of_.edges.size(); ++l)
    if (of_.edges[l].state)
      frame_.download.add_values(fmt::format("light {}", l), *of_.edges[l].state, sizeof(LightStateData));
}

bool PreparedShadowPlanesGpu::finish(scene::Rendering& result) const {
  frame_.finish(result);
  result.counters["rays"] = double(result.film.pixels());
  result.counters["airlight_terms_made"] = terms_made_;
  result.counters["silhouettes_made"] = silhouettes_made_;
  const auto all = frame_.download.values<CountersData>("counters");
  if (all.empty()) return true;  // nobody looks
  const CountersData& counted = all.front();
  if (counted.loops_were_cut)
    throw Unavailable(
        fmt::format("gpu: {} ends the loops of a pixel after 65535 iterations, too few for {} nodes and {} crossings",
                    context_.renderer(), options_.nodes, counted.crossings));
  if (counted.values_missing)
    throw Unavailable(fmt::format("gpu: values at the vertices of planes pass the {} bytes of a storage block of {}",
                                  context_.limits().storage_block, context_.renderer()));
  if (counted.unfinished[0]) return false;
  result.counters["lit_parts"] = counted.lit_parts;
  result.counters["crossings"] = counted.crossings;
  result.counters["gatherings_after_first"] = counted.gatherings_after_first;
  if (!of_.values) return true;
  double vertices = 0;
  for (std::size_t l = 0; l < scene_->lights.size(); ++l) {
    if (!scene::scatter(scene_->media, scene_->lights[l])) continue;
    const auto state = frame_.download.values<LightStateData>(fmt::format("light {}", l));
    const bool planes = !state.empty() && options_.shadows != Options::Shadows::none;
    const double of_planes = planes ? double(state.front().edge_count) * VertexValues::plane_rows(options_) : 0;
    for (int term = 0; term < airlight_terms_.count(); ++term) vertices += of_planes + double(of_.values->count(term));
  }
  result.counters["vertices"] = vertices;
  return true;
}

scene::Rendering PreparedShadowPlanesGpu::render(const View& view, const Execution& execution) const {
  require_lights_apart(*scene_, view, 1e-9, "shadow_planes_gpu");
  if (of_.values && view.camera.kind != scene::Camera::Kind::perspective)
    throw Error("evaluation = vertices is for perspective cameras");
  const Use use(context_);
  for (;; of_.rounds = 4 * of_.rounds + 1) {
    scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
    frame_.begin(execution);
    draw(view);
    if (finish(result)) return result;
  }
}

}  // namespace

std::string ShadowPlanes::about() const {
  return "shadow_planes in compute shaders: shadows in double precision, airlight in single (Biri et al. 2006)";
}

std::vector<scene::SettingSpec> ShadowPlanes::settings() const {
  Options of_device;
  of_device.nodes = 16;
  of_device.stretch = 3;
  std::vector<scene::SettingSpec> settings = airlight::shadow_planes::setting_specs(of_device);
  settings.push_back(scene::list_settings(FirstHits::bind).front());
  return settings;
}

std::vector<std::string> ShadowPlanes::supports(const Scene& scene, const scene::Settings& settings) const {
  return unsupported_on_device(scene, airlight::shadow_planes::read_options(settings));
}

std::unique_ptr<scene::Prepared> ShadowPlanes::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                 const scene::Settings& settings,
                                                                 const Execution&) const {
  return std::make_unique<PreparedShadowPlanesGpu>(std::move(scene), airlight::shadow_planes::read_options(settings),
                                                   scene::read_settings(FirstHits::bind, settings));
}

}  // namespace airlight::gpu::shadow_planes
