#include "gpu/shadow_planes/shadow_planes_gpu.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/program.h"
#include "gpu/raster/first_hits.h"
#include "gpu/raster_program.h"
#include "gpu/shadow_planes/shading.h"
#include "gpu/timer.h"
#include "methods/shadow_planes/general_position.h"
#include "methods/shadow_planes/paper_stages.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "scene/error.h"
#include "scene/light_on_ray.h"
#include "scene/single_precision.h"

namespace airlight::gpu {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;
using shadow_planes::Options;
using shadow_planes::SurfaceCount;

constexpr int most_degree = 16, most_media = 32;  // single precision; bits of a word

class PreparedShadowPlanesGpu final : public scene::Prepared {
 public:
  PreparedShadowPlanesGpu(std::shared_ptr<const Scene> scene, const Options& options)
      : scene_(std::move(scene)),
        options_(options),
        context_(Context::get()),
        airlight_terms_(context_, scene_, options),
        fan_(context_) {
    const bool lit = !scene_->lights.empty(), surfaces = !scene_->surfaces.empty();
    const bool balls = std::any_of(scene_->lights.begin(), scene_->lights.end(),
                                   [](const scene::Light& light) { return scene::ball(light)->radius > 0; });
    StageTimer timer(context_);
    if (surfaces || balls) {
      first_hits_ = std::make_unique<FirstHits>(context_, *scene_);
      timer.stage("upload");
    }
    shading_ = std::make_unique<PlaneShading>(context_, scene_, options_, airlight_terms_, surfaces_on_device());
    if (lit && surfaces) {
      occluders_ = std::make_shared<const shadow_planes::Occluders>(scene_);
      silhouettes_ = std::make_unique<Silhouettes>(context_, *occluders_);
      timer.stage("edges");
      edges_.resize(scene_->lights.size());
      find_silhouettes();
      timer.stage("silhouettes");
    }
    times_ = timer.times();
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  // Of every light, and m where it is asked for.
  void find_silhouettes() {
    counts_.clear();
    for (std::size_t l = 0; l < scene_->lights.size(); ++l) {
      silhouettes_->find(scene::ball(scene_->lights[l])->center, edges_[l]);
      counts_.emplace_back(occluders_, scene::ball(scene_->lights[l])->center);
    }
  }
  std::vector<int> counts_at_origins(std::size_t light, const View&, const Execution&) const;
  const SurfacesOnDevice* surfaces_on_device() const { return first_hits_ ? &first_hits_->surfaces() : nullptr; }
  // Adds one light; the number of vertices at which its airlight was computed.
  double add_light(int light, LitPicture&, const Execution&, StageTimer&) const;

  std::shared_ptr<const Scene> scene_;
  Options options_;
  Context& context_;
  AirlightTermsOnDevice airlight_terms_;
  std::unique_ptr<FirstHits> first_hits_;  // null: rays are infinite
  std::unique_ptr<PlaneShading> shading_;
  std::shared_ptr<const shadow_planes::Occluders> occluders_;
  std::unique_ptr<Silhouettes> silhouettes_;  // null: nothing casts a shadow
  std::vector<LightEdges> edges_;             // by light
  std::vector<SurfaceCount> counts_;
  mutable FanOnDevice fan_;
  mutable VertexValues values_;
  std::vector<scene::StageTime> times_;
};

std::vector<scene::Stage> PreparedShadowPlanesGpu::stages() const {
  std::size_t edges = 0;
  for (const LightEdges& of_light : edges_) edges += of_light.count;
  const bool lit = !scene_->lights.empty();
  const std::string dark = lit ? "one dispatch per light and air" : "no light shines";
  const std::string found = silhouettes_ ? shadow_planes::silhouettes_found(edges, scene_->lights.size())
                            : lit        ? "there are no surfaces"
                                         : dark;
  return {{"silhouettes", silhouettes_ != nullptr, found},
          {"edges of rays", silhouettes_ != nullptr,
           silhouettes_ ? "by angle around the line from light to camera" : found},
          {"airlight and surfaces", lit, dark},
          {"composition", true, "layers of the film"}};
}

std::optional<std::vector<scene::StageTime>> PreparedShadowPlanesGpu::next(std::shared_ptr<const Scene> scene,
                                                                           const Execution&) {
  if (scene->geometry != scene_->geometry || scene->lights.size() != scene_->lights.size()) return std::nullopt;
  const Use use(context_);
  if (first_hits_ && !first_hits_->move_balls(*scene)) return std::nullopt;
  scene_ = std::move(scene);
  if (!silhouettes_) return std::vector<scene::StageTime>{};
  StageTimer timer(context_);
  find_silhouettes();
  timer.stage("silhouettes");
  return timer.times();
}

std::vector<int> PreparedShadowPlanesGpu::counts_at_origins(std::size_t light, const View& view,
                                                            const Execution& execution) const {
  if (counts_.empty()) return {0};
  const Point3 at = scene::ball(scene_->lights[light])->center;
  const auto count = [&](const Point3& origin) {
    return counts_[light].at(shadow_planes::origin_in_general_position(origin, at));
  };
  if (view.camera.kind == scene::Camera::Kind::perspective) return {count(view.camera.position)};
  std::vector<int> counts(std::size_t(view.width) * view.height);
  scene::parallel_rows(view.height, {execution.threads, {}}, [&](int y) {
    for (int x = 0; x < view.width; ++x)
      counts[std::size_t(y) * view.width + x] =
          count(camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height).origin);
  });
  return counts;
}

double PreparedShadowPlanesGpu::add_light(int l, LitPicture& picture, const Execution& execution,
                                          StageTimer& timer) const {
  const Point3 light = scene::ball(scene_->lights[l])->center, camera = picture.view.camera.position;
  const std::vector<int> counts = counts_at_origins(l, picture.view, execution);
  PlaneShading::Edges lists;
  if (silhouettes_) {
    fan_.fill(picture.view.camera, light, edges_[l]);
    lists = {&edges_[l], &fan_};
    timer.stage("edges of rays");
  }
  double vertices = 0;
  for (int term = 0; term < airlight_terms_.count(); ++term) {
    const bool by_vertex = options_.evaluation == Options::Evaluation::vertices;
    if (by_vertex) {
      const double far = lists.edges ? shadow_planes::mesh_reach(*scene_, airlight_terms_.region(term), light, camera,
                                                                 options_.plane_levels)
                                     : 0;
      const bool planes = lists.edges && options_.shadows != Options::Shadows::none;
      values_.fill(context_, *scene_, options_, airlight_terms_, l, term, camera, surfaces_on_device(),
                   planes ? lists.edges : nullptr, far, picture.counters, timer);
      vertices += double(values_.count());
    }
    shading_->add(picture, l, term, counts, lists, by_vertex ? &values_ : nullptr);
    timer.stage("airlight and surfaces");
  }
  if (airlight_terms_.count() == 0) {
    shading_->add(picture, l, -1, counts, lists, nullptr);
    timer.stage("airlight and surfaces");
  }
  return vertices;
}

scene::Rendering PreparedShadowPlanesGpu::render(const View& view, const Execution& execution) const {
  require_lights_apart(*scene_, view, 1e-9, "shadow_planes_gpu");
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  const std::size_t pixels = result.film.pixels();
  const long dispatches = Program::dispatches(), draws = RasterProgram::draws();
  if (options_.evaluation == Options::Evaluation::vertices && view.camera.kind != scene::Camera::Kind::perspective)
    throw Error("evaluation = vertices is for perspective cameras");
  const Use use(context_);
  StageTimer timer(context_);
  LitPicture picture(context_, view, silhouettes_ != nullptr);
  if (first_hits_) {
    picture.primitives = std::make_unique<Buffer>(context_, "primitives", pixels * 4);
    const Buffer distances(context_, "distances", pixels * 4);
    first_hits_->find(view, distances, picture.primitives.get());
    timer.stage("distances");
  }
  double vertices = 0;
  for (std::size_t l = 0; l < scene_->lights.size(); ++l) vertices += add_light(int(l), picture, execution, timer);
  const auto layer = [&](const char* name) { return Buffer(context_, name, pixels * 12); };
  const PlaneShading::Layers layers{layer("airlight"), layer("transmittance"), layer("surface"), layer("mean")};
  shading_->compose(picture, layers);
  timer.stage("composition");
  result.film.layers["airlight"] = layers.airlight.download<float>();
  result.film.layers["transmittance"] = layers.transmittance.download<float>();
  result.film.layers["surface"] = layers.surface.download<float>();
  result.film.layers["mean"] = layers.mean.download<float>();
  const std::vector<unsigned> counted = picture.counters.download<unsigned>();
  timer.stage("read back");
  result.times = timer.times();
  result.counters["rays"] = double(pixels);
  result.counters["lit_parts"] = counted[0];
  result.counters["crossings"] = counted[1];
  result.counters["gatherings_beyond_32"] = counted[2];
  if (options_.evaluation == Options::Evaluation::vertices) result.counters["vertices"] = vertices;
  result.counters["dispatches"] = double(Program::dispatches() - dispatches);
  result.counters["draws"] = double(RasterProgram::draws() - draws);
  return result;
}

}  // namespace

std::string ShadowPlanesGpu::about() const {
  return "shadow_planes in compute shaders: shadows in double precision, airlight in single (Biri et al. 2006)";
}

std::vector<scene::SettingSpec> ShadowPlanesGpu::settings() const {
  std::vector<scene::SettingSpec> settings = shadow_planes::ShadowPlanes().settings();
  for (scene::SettingSpec& setting : settings) {
    if (setting.name == "nodes") setting.fallback = "16";
    if (setting.name == "stretch") setting.fallback = "3";
  }
  return settings;
}

std::vector<std::string> ShadowPlanesGpu::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = shadow_planes::ShadowPlanes().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  const Options options = shadow_planes::read_options(settings);
  if (options.evaluator == Options::Evaluator::polynomial && options.degree > most_degree)
    reasons.push_back(fmt::format("degree = {}: single precision takes {} at most", options.degree, most_degree));
  if (scene.media.size() > most_media)
    reasons.push_back(fmt::format("{} media: the shader has room for {}", scene.media.size(), most_media));
  return reasons;
}

std::unique_ptr<scene::Prepared> ShadowPlanesGpu::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                    const scene::Settings& settings,
                                                                    const Execution&) const {
  return std::make_unique<PreparedShadowPlanesGpu>(std::move(scene), shadow_planes::read_options(settings));
}

}  // namespace airlight::gpu
