#include "gpu/compensated_ray_marching/compensated_ray_marching_gpu.h"

#include <fmt/format.h>

#include <cmath>

#include "gpu/compensated_ray_marching/smoke_density.h"
#include "gpu/compensated_ray_marching/smoke_source.h"
#include "gpu/environment_lights.h"
#include "gpu/frame.h"
#include "gpu/raster/backdrops.h"
#include "gpu/view_uniforms.h"
#include "gpu/wavelet_fog/surface_light.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/single_precision.h"
#include "scene/stopwatch.h"

namespace airlight::gpu {
namespace {

using namespace smoke;
using compensated_ray_marching::IncomingLight;
using compensated_ray_marching::LitGrid;
using compensated_ray_marching::Options;
using compensated_ray_marching::SmokeField;
using scene::Execution;
using scene::Scene;
using scene::View;

constexpr int tile = 8;  // of rays, both ways

class PreparedSmokeGpu final : public scene::Prepared {
 public:
  PreparedSmokeGpu(std::shared_ptr<const Scene>, const Options&, std::string settings, const Execution&);

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  bool ambient() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && smoke_; }
  bool behind() const { return environments_->count() > 0; }
  void set_environments();
  void set_lamps();
  void find_ends(const View&) const;
  void march(const View&) const;
  void look_behind(const View&) const;
  void light_surfaces(const View&) const;
  void dim(const View&, const scene::Light&) const;
  void compose(std::size_t pixels) const;
  Buffer& of_pixels(const char* name, const View& view, std::size_t bytes) const {
    return frame_.buffers.get(name, bytes * std::size_t(view.width) * std::size_t(view.height));
  }

  std::shared_ptr<const Scene> first_, scene_;  // the first has the smoke
  Options options_;
  std::string settings_;
  std::optional<SmokeField> smoke_;  // nothing where no medium extinguishes
  std::optional<IncomingLight> incoming_;
  std::optional<LitGrid> grid_;
  Point3 middle_ = Point3::Zero();  // of the smoke
  double slice_ = 0;                // [m] across
  Context& context_;
  std::unique_ptr<SmokeDensity> density_;
  std::unique_ptr<SmokeSource> source_;
  std::unique_ptr<EnvironmentLights> environments_;
  std::unique_ptr<FirstHits> first_hits_;            // null: there are no surfaces
  std::unique_ptr<Backdrops> backdrops_;             // null: there are none
  std::unique_ptr<fogmaps::SurfaceLight> surfaces_;  // null: there are no surfaces
  Scene lamps_;  // the surfaces, lit from the directions that light is gathered from
  Program *ranges_ = nullptr, *march_ = nullptr, *composition_ = nullptr, *dim_ = nullptr;
  std::vector<Program*> behind_;  // for each environment
  mutable Frame frame_;
  std::vector<scene::StageTime> times_;
};

PreparedSmokeGpu::PreparedSmokeGpu(std::shared_ptr<const Scene> scene, const Options& options, std::string settings,
                                   const Execution& execution)
    : first_(scene),
      scene_(std::move(scene)),
      options_(options),
      settings_(std::move(settings)),
      context_(Context::get()),
      frame_(context_) {
  for (const scene::Medium& medium : scene_->media)
    if (extinguishes(medium) && !compensated_ray_marching::smoke_box(medium).empty()) smoke_.emplace(medium, options_);
  scene::Stopwatch watch;
  incoming_.emplace(scene_->lights, options_.grid.levels);
  times_.push_back({"environment", watch.lap()});
  if (smoke_) {
    grid_.emplace(*scene_, smoke_->medium(), options_, *incoming_, execution);
    times_.insert(times_.end(), grid_->times().begin(), grid_->times().end());
  }
  const Use use(context_);
  StageTimer timer(context_);
  timer.begin("upload");
  set_environments();
  if (!scene_->backdrops.empty()) backdrops_ = std::make_unique<Backdrops>(context_, *scene_);
  if (scene_->geometry) {
    first_hits_ = std::make_unique<FirstHits>(context_, *scene_);
    lamps_ = *scene_;
    set_lamps();
    Scene any = lamps_;  // its programs are wanted even when no direction has light yet
    any.lights = {scene::DirectionalLight{}};
    surfaces_ = std::make_unique<fogmaps::SurfaceLight>(context_, any, first_hits_.get());
  }
  composition_ = &program(context_, "smoke_composition", 64, 1, {});
  if (smoke_) {
    const Box box = compensated_ray_marching::smoke_box(smoke_->medium());
    middle_ = box.center();
    slice_ = box.size().maxCoeff() / options_.slices;
    density_ = std::make_unique<SmokeDensity>(context_, *smoke_, middle_);
    source_ = std::make_unique<SmokeSource>(context_, smoke_->medium(), options_, *grid_, *incoming_);
    ranges_ = &program(context_, "ranges", tile, tile, density_->definitions());
    march_ = &program(context_, "march", tile, tile, density_->definitions());
    if (surfaces_) dim_ = &program(context_, "smoke_dim", tile, tile, density_->definitions());
    grid_->aim(*incoming_, execution);
    source_->light(*grid_, *incoming_, true, timer, execution);
  }
  const std::vector<scene::StageTime> lit = timer.times();
  times_.insert(times_.end(), lit.begin(), lit.end());
}

void PreparedSmokeGpu::set_environments() {
  environments_ = std::make_unique<EnvironmentLights>(context_, *scene_);
  behind_.clear();
  for (int l = 0; l < environments_->count(); ++l)
    behind_.push_back(&program(context_, "smoke_behind", tile, tile, environments_->definitions(l)));
}

// What surfaces reflect comes from the directions that smoke is lit from, one after the other.
void PreparedSmokeGpu::set_lamps() {
  lamps_.lights.clear();
  for (std::size_t k = 0; k < incoming_->directions().size(); ++k)
    if ((incoming_->power()[k] != 0).any())
      lamps_.lights.push_back(scene::DirectionalLight{incoming_->directions()[k], incoming_->power()[k]});
}

// Lights alone: the smoke, its depths and the last multiple scattering stay on the device.
std::optional<std::vector<scene::StageTime>> PreparedSmokeGpu::next(std::shared_ptr<const Scene> scene,
                                                                    const Execution& execution) {
  if (scene->matter_hash != scene_->matter_hash || !compensated_ray_marching::reasons_against(*scene, options_).empty())
    return std::nullopt;
  const Use use(context_);
  scene_ = std::move(scene);
  if (!environments_->become(*scene_)) set_environments();
  std::vector<scene::StageTime> times;
  scene::Stopwatch watch;
  incoming_->become(scene_->lights);
  if (surfaces_) set_lamps();
  times.push_back({"environment", watch.lap()});
  if (!smoke_) return times;
  const bool aimed = grid_->aim(*incoming_, execution);
  times.insert(times.end(), grid_->times().begin(), grid_->times().end());
  StageTimer timer(context_);
  source_->light(*grid_, *incoming_, aimed, timer, execution);
  const std::vector<scene::StageTime> lit = timer.times();
  times.insert(times.end(), lit.begin(), lit.end());
  return times;
}

std::vector<scene::Stage> PreparedSmokeGpu::stages() const {
  const std::string none = "no medium extinguishes";
  const bool scatters = smoke_ && (smoke_->medium().albedo * smoke_->medium().sigma_t).maxCoeff() > 0;
  const bool multiple = smoke_ && grid_->single_only().empty();
  std::string again = smoke_ ? grid_->single_only() : none;
  if (multiple)
    again = fmt::format("{} bands, deepest cell {:.2g}; {} iterations, error about {:.1g}{}", options_.order,
                        grid_->deepest_cell(), source_->iterations(), source_->error(),
                        source_->error() > options_.tolerance ? ": more than the tolerance" : "");
  return {
      {"single scattering", scatters,
       !smoke_    ? none
       : scatters ? fmt::format("{} nodes, {} directions", grid_->nodes().size(), incoming_->directions().size())
                  : "the albedo is 0"},
      {"multiple scattering", multiple, again},
      {"march", smoke_.has_value(), smoke_ ? fmt::format("slices of {:.3g} m", slice_) : none},
      {"ends", first_hits_ || backdrops_,
       first_hits_ || backdrops_ ? "where surfaces and backdrops end camera rays" : "nothing ends a ray"},
      {"surfaces", bool(surfaces_),
       surfaces_ ? fmt::format("lit from {} directions, through the smoke", lamps_.lights.size()) : "there are none"},
      {"background", behind(), behind() ? "environments through the smoke" : "nothing stands behind"},
      {"composition", true, "layers of the film"}};
}

void PreparedSmokeGpu::find_ends(const View& view) const {
  const Buffer& distances = of_pixels("distances", view, 4);
  if (first_hits_) {
    const Buffer& primitives = of_pixels("primitives", view, 4);
    first_hits_->find(view, distances, &primitives);
  }
  if (backdrops_) backdrops_->find(view, distances, bool(first_hits_), of_pixels("seen", view, 12));
}

void PreparedSmokeGpu::march(const View& view) const {
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  const Buffer& ranges = frame_.buffers.get("ranges", 16 * pixels);
  const Buffer &airlight = frame_.buffers.get("airlight", 12 * pixels),
               &column = frame_.buffers.get("column", 4 * pixels);
  Program& find = *ranges_;
  const bool ends = first_hits_ || backdrops_;
  (ends ? of_pixels("distances", view, 4) : ranges).bind(at::distances);
  find.set("has_ends", ends);
  ranges.bind(at::ranges);
  airlight.bind(at::airlight);
  column.bind(at::column);
  set_camera(find, view, middle_);
  density_->bind(find);
  find.set("slice", slice_);
  find.set("widths2", density_->widths2());
  find.dispatch(view.width, view.height);
  Program& p = *march_;
  source_->logarithms().bind(at::logarithms);
  set_camera(p, view, middle_);
  density_->bind(p);
  source_->set_grid(p, middle_);
  p.set("sigma_t", smoke_->medium().sigma_t);
  p.set("weight", int(options_.weight));
  const int most = int(std::ceil(density_->longest() / slice_)) + 2;
  for (int first = 0; first < most; first += density_->slices()) {
    p.set("first_slice", first);
    p.dispatch(view.width, view.height);
  }
}

void PreparedSmokeGpu::look_behind(const View& view) const {
  for (int l = 0; l < environments_->count(); ++l) {
    Program& p = *behind_[std::size_t(l)];
    set_camera(p, view);
    environments_->bind(l, p);
    p.set("first", l == 0);
    (first_hits_ ? of_pixels("primitives", view, 4) : of_pixels("surface", view, 12)).bind(at::primitives);
    p.set("has_primitives", bool(first_hits_));
    p.dispatch(view.width, view.height);
  }
}

void PreparedSmokeGpu::light_surfaces(const View& view) const {
  Buffer& lit = of_pixels("lit", view, sizeof(fogmaps::LitData));
  if (lamps_.lights.empty()) lit.clear();
  surfaces_->render(lamps_, view, &of_pixels("primitives", view, 4), lit,
                    [&](const scene::Light& light) { dim(view, light); });
}

void PreparedSmokeGpu::dim(const View& view, const scene::Light& light) const {
  if (!smoke_) return;
  Program& p = *dim_;
  of_pixels("lit", view, sizeof(fogmaps::LitData)).bind(at::lit);
  density_->bind(p);
  set_view(p, view);
  p.set_double("middle", middle_);
  p.set("to_light", std::get<scene::DirectionalLight>(light).to_light);
  p.set("sigma_t", smoke_->medium().sigma_t);
  p.set("widths2", density_->widths2());
  p.set("loop_count", 3);
  p.dispatch(view.width, view.height);
}

void PreparedSmokeGpu::compose(std::size_t pixels) const {
  Program& p = *composition_;
  const auto layer = [&](const char* name, int binding) {
    const Buffer& buffer = frame_.buffers.get(name, 12 * pixels);
    buffer.bind(binding);
    frame_.download.add(name, buffer, 12 * pixels);
  };
  layer("mean", at::mean);
  layer("transmittance", at::transmittance);
  layer("airlight", at::airlight);
  layer("surface", at::surface);
  if (ambient())
    layer("ambient", at::ambient);
  else
    frame_.buffers.get("mean", 12 * pixels).bind(at::ambient);
  p.set("values", int(3 * pixels));
  frame_.buffers.get("column", 4 * pixels).bind(at::column);
  p.set("sigma_t", smoke_ ? smoke_->medium().sigma_t : Rgb(Rgb::Zero()));
  p.set("has_smoke", smoke_.has_value());
  p.set("has_behind", behind());
  const Buffer& column = frame_.buffers.get("column", 4 * pixels);
  (surfaces_ ? frame_.buffers.get("lit", sizeof(fogmaps::LitData) * pixels) : column).bind(at::lit);
  (backdrops_ ? frame_.buffers.get("seen", 12 * pixels) : column).bind(at::seen);
  p.set("has_lit", bool(surfaces_));
  p.set("has_seen", bool(backdrops_));
  p.set("has_ambient", ambient());
  p.set("ambient", ambient() ? scene_->ambient_in_scatter : Rgb(Rgb::Zero()));
  p.dispatch(int(3 * pixels));
}

scene::Rendering PreparedSmokeGpu::render(const View& view, const Execution& execution) const {
  const Use use(context_);
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  frame_.begin(execution);
  if (first_hits_ || backdrops_) {
    frame_.timer.begin("ends");
    find_ends(view);
  }
  if (smoke_) {
    frame_.timer.begin("towards the camera");
    source_->towards(view, middle_);
    frame_.timer.begin("march");
    march(view);
  }
  frame_.buffers.get("surface", 12 * pixels).bind(at::surface);
  if (surfaces_) {
    frame_.timer.begin("surfaces");
    light_surfaces(view);
    frame_.buffers.get("surface", 12 * pixels).bind(at::surface);
  }
  if (behind()) {
    frame_.timer.begin("background");
    look_behind(view);
  }
  frame_.timer.begin("composition");
  compose(pixels);
  frame_.finish(result);
  result.counters["rays"] = double(pixels);
  if (smoke_) {
    result.counters["iterations"] = source_->iterations();
    result.counters["multiple_error"] = source_->error();
    result.counters["deepest_cell"] = grid_->deepest_cell();
  }
  result.film.metadata = {{"method", "compensated_ray_marching_gpu"},
                          {"settings", settings_},
                          {"scene", scene_->name},
                          {"hash", scene_->hash}};
  const bool again = grid_ && grid_->single_only().empty();
  if (const std::string doubt = compensated_ray_marching::doubt_of(*scene_, options_, again); !doubt.empty())
    result.film.metadata["warning"] = "compensated_ray_marching_gpu: " + doubt;
  return result;
}

}  // namespace

std::string CompensatedRayMarchingGpu::about() const {
  return "compensated_ray_marching in compute shaders: discrete ordinates and the march on the device (Zhou et al. 2008)";
}

std::vector<scene::SettingSpec> CompensatedRayMarchingGpu::settings() const {
  return compensated_ray_marching::CompensatedRayMarching().settings();
}

std::vector<std::string> CompensatedRayMarchingGpu::supports(const Scene& scene,
                                                             const scene::Settings& settings) const {
  std::vector<std::string> reasons = compensated_ray_marching::CompensatedRayMarching().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  for (const std::string& reason : smoke::reasons_against(scene, compensated_ray_marching::read_options(settings)))
    reasons.push_back(reason);
  return reasons;
}

std::unique_ptr<scene::Prepared> CompensatedRayMarchingGpu::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                              const scene::Settings& settings,
                                                                              const Execution& execution) const {
  return std::make_unique<PreparedSmokeGpu>(std::move(scene), compensated_ray_marching::read_options(settings),
                                            settings.canonical(), execution);
}

}  // namespace airlight::gpu
