#include "gpu/compensated_ray_marching/compensated_ray_marching_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/compensated_ray_marching/centre_sources_on_device.h"
#include "gpu/compensated_ray_marching/map_projection.h"
#include "gpu/compensated_ray_marching/smoke_density.h"
#include "gpu/compensated_ray_marching/smoke_source.h"
#include "gpu/compensated_ray_marching/smoke_volume.h"
#include "gpu/compensated_ray_marching/surroundings.h"
#include "gpu/film_layers.h"
#include "gpu/view_uniforms.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/base/stopwatch.h"
#include "scene/light/scattered_lights.h"
#include "scene/single_precision.h"

namespace airlight::gpu {
namespace {

using namespace smoke;
using compensated_ray_marching::EnvironmentBands;
using compensated_ray_marching::IncomingLight;
using compensated_ray_marching::LitGrid;
using compensated_ray_marching::Options;
using compensated_ray_marching::SmokeField;
using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedSmokeGpu final : public scene::Prepared {
 public:
  // Iterations begin with the last solution, if there is one.
  PreparedSmokeGpu(std::shared_ptr<const Scene>, const Options&, std::string settings,
                   compensated_ray_marching::Solution last, const Execution&);

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;
  std::unique_ptr<PreparedSmokeGpu> in_other_smoke(std::shared_ptr<const Scene>, const Execution&) const;

 private:
  bool paper() const { return options_.variant == Options::Variant::paper; }
  bool ambient() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && smoke_; }
  void begin_environments();
  void begin_grid(StageTimer&, const Execution&);
  void begin_centres(StageTimer&, const Execution&);
  std::vector<scene::StageTime> light(const Execution&);
  void march(const View&) const;
  void light_surfaces(const View&) const;
  void dim(const View&, const scene::Light&) const;
  void compose(const View&) const;
  Buffer& of_pixels(const char* name, const View& view, std::size_t bytes) const {
    return smoke::of_pixels(frame_, name, view, bytes);
  }

  std::shared_ptr<const Scene> first_, scene_;  // the first has the smoke
  Options options_;
  std::string settings_;
  compensated_ray_marching::Solution last_;  // of a frame before, where this one has none
  std::optional<SmokeField> smoke_;          // nothing where no medium extinguishes
  bool scatters_ = false;                    // the smoke, something of the light
  std::unique_ptr<MapProjection> projection_;
  std::optional<IncomingLight> incoming_;  // of grid
  std::optional<EnvironmentBands> bands_;  // of paper
  std::optional<LitGrid> grid_;
  Point3 middle_ = Point3::Zero();  // of the smoke
  double slice_ = 0;                // [m] across
  Context& context_;
  std::unique_ptr<Surroundings> surroundings_;
  std::unique_ptr<SmokeDensity> density_;
  std::unique_ptr<SmokeDensity> centre_density_;    // of paper through voxels: the Gaussians
  std::unique_ptr<SmokeVolume> volume_;             // of paper through voxels
  std::unique_ptr<SmokeColumns> columns_;           // of grid
  std::unique_ptr<SmokeSource> source_;             // of grid
  std::unique_ptr<CentreSourcesOnDevice> centres_;  // of paper
  Program *ranges_ = nullptr, *march_ = nullptr, *composition_ = nullptr, *dim_ = nullptr;
  mutable Frame frame_;
  std::vector<scene::StageTime> times_;
};

std::vector<std::string> unsupported_on_device(const Scene& scene, const Options& options) {
  std::vector<std::string> reasons = compensated_ray_marching::unsupported(scene, options);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  for (const std::string& reason : smoke::unsupported(scene, options)) reasons.push_back(reason);
  return reasons;
}

// The same name again adds up.
void append(std::vector<scene::StageTime>& times, const std::vector<scene::StageTime>& more) {
  for (const scene::StageTime& time : more) {
    const auto same = std::find_if(times.begin(), times.end(), [&](const auto& t) { return t.name == time.name; });
    if (same == times.end())
      times.push_back(time);
    else
      same->seconds += time.seconds;
  }
}

PreparedSmokeGpu::PreparedSmokeGpu(std::shared_ptr<const Scene> scene, const Options& options, std::string settings,
                                   compensated_ray_marching::Solution last, const Execution& execution)
    : first_(scene),
      scene_(std::move(scene)),
      options_(options),
      settings_(std::move(settings)),
      last_(std::move(last)),
      context_(Context::get()),
      frame_(context_) {
  using compensated_ray_marching::ResidualStore;
  if (options_.paper.store == ResidualStore::automatic) options_.paper.store = ResidualStore::bricks;
  for (const scene::Medium& medium : scene_->media)
    if (extinguishes(medium) && !compensated_ray_marching::smoke_box(medium).empty()) smoke_.emplace(medium, options_);
  scatters_ = smoke_ && scene::why_nothing_scatters(*scene_).empty();
  const Use use(context_);
  StageTimer timer(context_);
  timer.begin("upload");
  surroundings_ = std::make_unique<Surroundings>(context_, *scene_);
  append(times_, timer.times());
  begin_environments();
  if (!paper() && scatters_) {
    grid_.emplace(*scene_, smoke_->medium(), options_, *incoming_, execution);
    append(times_, grid_->times());
  }
  timer.restart();
  timer.begin("upload");
  composition_ = &program(context_, "smoke_composition", 64, 1, {});
  if (smoke_) {
    const Box box = compensated_ray_marching::smoke_box(smoke_->medium());
    middle_ = box.center();
    slice_ = box.size().maxCoeff() / options_.slices;
    density_ = std::make_unique<SmokeDensity>(context_, *smoke_, middle_, paper());
    ranges_ = &program(context_, "ranges", pixel_tile, pixel_tile, density_->definitions());
    Definitions definitions = density_->definitions();
    definitions["SCATTERS"] = scatters_ ? "1" : "0";
    march_ = &program(context_, "march", pixel_tile, pixel_tile, definitions);
  }
  paper() ? begin_centres(timer, execution) : begin_grid(timer, execution);
  append(times_, timer.times());
  if (paper()) append(times_, light(execution));
}

void PreparedSmokeGpu::begin_environments() {
  const int order = paper() ? options_.order : options_.grid.levels;
  EnvironmentBands bands(order, [this, order](const std::shared_ptr<const scene::EnvironmentMap>& map) {
    if (!projection_) projection_ = std::make_unique<MapProjection>(context_, order);
    return projection_->of(*map, surroundings_->environments().texels(map));
  });
  if (paper()) {
    bands_.emplace(std::move(bands));
    return;
  }
  scene::Stopwatch watch;
  incoming_.emplace(scene_->lights, std::move(bands));
  times_.push_back({"environment", watch.lap()});
}

void PreparedSmokeGpu::begin_grid(StageTimer& timer, const Execution& execution) {
  if (surroundings_->surfaces()) surroundings_->set_lamps(*scene_, *incoming_);
  if (!smoke_) return;
  if (surroundings_->surfaces())
    dim_ = &program(context_, "smoke_dim", pixel_tile, pixel_tile, density_->definitions());
  if (!scatters_) return;
  columns_ = std::make_unique<SmokeColumns>(context_, *first_, *grid_, *density_, middle_);
  source_ = std::make_unique<SmokeSource>(context_, smoke_->medium(), options_, *grid_, *columns_);
  source_->begin_with(last_);
  source_->light(*incoming_, timer, execution);
}

void PreparedSmokeGpu::begin_centres(StageTimer& timer, const Execution& execution) {
  static const scene::GaussianSum no_smoke;
  static const scene::Medium clear;
  if (smoke_ && smoke_->voxels()) {
    centre_density_ = std::make_unique<SmokeDensity>(context_, smoke_->centres(), middle_);
    volume_ = std::make_unique<SmokeVolume>(context_, *smoke_);
  }
  centres_ = std::make_unique<CentreSourcesOnDevice>(
      context_, smoke_ ? smoke_->centres() : no_smoke, smoke_ ? smoke_->medium() : clear, scene_->surfaces, scatters_,
      volume_ ? centre_density_.get() : density_.get(), middle_, options_, timer, execution);
  centres_->begin_with(last_);
}

// Lights alone: the smoke, its depths and the last multiple scattering stay on the device.
std::optional<std::vector<scene::StageTime>> PreparedSmokeGpu::next(std::shared_ptr<const Scene> scene,
                                                                    const Execution& execution) {
  if (scene->matter_hash != scene_->matter_hash || !compensated_ray_marching::unsupported(*scene, options_).empty() ||
      (incoming_ && !incoming_->fits(scene->lights)) ||
      (smoke_ && !scatters_ && scene::why_nothing_scatters(*scene).empty()))
    return std::nullopt;
  const Use use(context_);
  scene_ = std::move(scene);
  surroundings_->become(*scene_);
  return light(execution);
}

// Without a solution nothing is kept: then the next frame is prepared anew. A frame without smoke passes on what it was given.
std::unique_ptr<PreparedSmokeGpu> PreparedSmokeGpu::in_other_smoke(std::shared_ptr<const Scene> scene,
                                                                   const Execution& execution) const {
  if (!unsupported_on_device(*scene, options_).empty()) return nullptr;
  const Use use(context_);
  compensated_ray_marching::Solution now = source_    ? source_->solution()
                                           : centres_ ? centres_->solution()
                                                      : compensated_ray_marching::Solution{};
  if (now.empty()) now = last_;
  if (now.empty()) return nullptr;
  return std::make_unique<PreparedSmokeGpu>(std::move(scene), options_, settings_, std::move(now), execution);
}

std::vector<scene::StageTime> PreparedSmokeGpu::light(const Execution& execution) {
  std::vector<scene::StageTime> times;
  StageTimer timer(context_);
  scene::Stopwatch watch;
  if (centres_) {
    const auto light = bands_->of(scene_->lights);
    times.push_back({"environment", watch.lap()});
    timer.restart();
    centres_->light(light, timer, execution);
    append(times, timer.times());
    return times;
  }
  incoming_->become(scene_->lights);
  if (surroundings_->surfaces()) surroundings_->set_lamps(*scene_, *incoming_);
  times.push_back({"environment", watch.lap()});
  if (!scatters_) return times;
  timer.restart();
  source_->light(*incoming_, timer, execution);
  append(times, timer.times());
  return times;
}

std::vector<scene::Stage> PreparedSmokeGpu::stages() const {
  const std::string none = "no medium extinguishes";
  const std::string dark = smoke_ ? scene::why_nothing_scatters(*scene_) : none;
  std::string again = grid_ ? grid_->single_only() : none, how = none;
  if (grid_) how = fmt::format("{} nodes, {} directions", grid_->nodes().size(), incoming_->directions().size());
  bool multiple = grid_ && grid_->single_only().empty();
  if (scatters_ && centres_) {
    how = fmt::format("{} centres, {} bands", centres_->centres(), options_.order);
    again = centres_->single_only();
    multiple = again.empty();
    if (multiple) again = fmt::format("{} iterations, residual {:.1g}", centres_->iterations(), centres_->residual());
  } else if (multiple)
    again = fmt::format("{} bands, deepest cell {:.2g}; {} iterations, error about {:.1g}{}", options_.order,
                        grid_->deepest_cell(), source_->iterations(), source_->error(),
                        source_->error() > options_.tolerance ? ": more than the tolerance" : "");
  return {{"single scattering", scatters_, scatters_ ? how : dark},
          {"multiple scattering", multiple, scatters_ ? again : dark},
          {"residual", smoke_ && smoke_->with_residual(),
           !smoke_                   ? none
           : smoke_->with_residual() ? fmt::format("added to the Gaussians, from {}", smoke_->residual()->name())
           : paper()                 ? "the Gaussians are all"
                                     : "the field itself is marched through"},
          {"volume pass", bool(volume_),
           volume_ ? fmt::format("density and source at {} x {} x {} voxels", smoke_->voxels()->size[0],
                                 smoke_->voxels()->size[1], smoke_->voxels()->size[2])
                   : "no Gaussians with voxels of variant = paper"},
          {"march", smoke_.has_value(), smoke_ ? fmt::format("slices of {:.3g} m", slice_) : none},
          {"ends", surroundings_->ends(),
           surroundings_->ends() ? "where surfaces and backdrops end camera rays" : "nothing ends a ray"},
          {"surfaces", bool(surroundings_->surfaces()),
           !surroundings_->surfaces() ? "there are none"
           : centres_ ? fmt::format("lit by the environment in bands, past {} spheres", centres_->objects())
                      : fmt::format("lit from {} directions, through the smoke", surroundings_->lamps())},
          {"background", surroundings_->behind(),
           surroundings_->behind() ? "environments through the smoke" : "nothing stands behind"},
          {"composition", true, "layers of the film"}};
}

void PreparedSmokeGpu::march(const View& view) const {
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  const Buffer& ranges = frame_.buffers.get("ranges", 16 * pixels);
  const Buffer &airlight = frame_.buffers.get("airlight", 12 * pixels),
               &column = frame_.buffers.get("column", 4 * pixels);
  Program& find = *ranges_;
  const bool ends = surroundings_->ends();
  (ends ? of_pixels("distances", view, 4) : ranges).bind(at::distances);
  find.set("has_ends", ends);
  ranges.bind(at::ranges);
  airlight.bind(at::airlight_layer);
  column.bind(at::column);
  set_camera(find, view, middle_);
  density_->bind(find);
  find.set("slice", slice_);
  find.set("widths2", density_->widths2());
  find.dispatch(view.width, view.height);
  Program& p = *march_;
  set_camera(p, view, middle_);
  density_->bind(p);
  if (volume_) {
    volume_->values().bind(at::volume);
  } else if (centres_) {
    centres_->sources().bind(at::centre_sources);
    p.set("least_source_density", smoke_->least_density());
  } else if (scatters_) {
    source_->logarithms().bind(at::logarithms);
    set_grid(p, grid_->grid(), middle_);
    p.set("brightest", compensated_ray_marching::has_hard_edges(smoke_->medium())
                           ? Rgb((smoke_->medium().albedo * incoming_->brightest()).min(1e37))
                           : Rgb(Rgb::Constant(1e37)));
  }
  p.set("sigma_t", smoke_->medium().sigma_t);
  p.set("weight", int(options_.weight));
  const int most = int(std::ceil(density_->longest() / slice_)) + 2;
  for (int first = 0; first < most; first += density_->slices()) {
    p.set("first_slice", first);
    p.dispatch(view.width, view.height);
  }
}

void PreparedSmokeGpu::light_surfaces(const View& view) const {
  if (centres_)
    centres_->light_surfaces(view, surroundings_->surfaces()->surfaces(), of_pixels("primitives", view, 4),
                             of_pixels("lit", view, sizeof(fogmaps::LitData)));
  else
    surroundings_->light_surfaces(view, frame_, [&](const scene::Light& light) { dim(view, light); });
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

void PreparedSmokeGpu::compose(const View& view) const {
  Program& p = *composition_;
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  bind_film_layers(frame_, pixels, p,
                   {at::mean_layer, at::transmittance_layer, at::surface_layer, at::airlight_layer, at::ambient_layer},
                   {true, ambient() ? std::optional(scene_->ambient_in_scatter) : std::nullopt});
  p.set("pixels", int(pixels));
  const Buffer& column = of_pixels("column", view, 4);
  column.bind(at::column);
  p.set("sigma_t", smoke_ ? smoke_->medium().sigma_t : Rgb(Rgb::Zero()));
  p.set("has_smoke", smoke_.has_value());
  p.set("has_behind", surroundings_->behind());
  const bool lit = surroundings_->surfaces(), seen = surroundings_->backdrops();
  (lit ? of_pixels("lit", view, sizeof(fogmaps::LitData)) : column).bind(at::lit);
  (seen ? of_pixels("seen", view, 12) : column).bind(at::seen);
  p.set("has_lit", lit);
  p.set("has_seen", seen);
  p.dispatch(int(pixels));
}

scene::Rendering PreparedSmokeGpu::render(const View& view, const Execution& execution) const {
  const Use use(context_);
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  frame_.begin(execution);
  if (surroundings_->ends()) {
    frame_.timer.begin("ends");
    surroundings_->find_ends(view, frame_);
  }
  if (smoke_) {
    if (scatters_) {
      frame_.timer.begin("towards the camera");
      centres_ ? centres_->towards(view) : source_->towards(view, middle_);
    }
    if (volume_) {
      frame_.timer.begin("volume pass");
      volume_->find(centres_->sources());
    }
    frame_.timer.begin("march");
    march(view);
  }
  if (surroundings_->surfaces()) {
    frame_.timer.begin("surfaces");
    light_surfaces(view);
  }
  if (surroundings_->behind()) {
    frame_.timer.begin("background");
    surroundings_->look_behind(view, frame_);
  }
  frame_.timer.begin("composition");
  compose(view);
  frame_.finish(result);
  result.counters["rays"] = double(pixels);
  if (centres_) {
    result.counters["iterations"] = centres_->iterations();
    result.counters["multiple_error"] = centres_->residual();
    result.counters["negative_share"] = centres_->negative_share();
  } else if (scatters_) {
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
  return "compensated_ray_marching in compute shaders: on a grid or at the centres of Gaussians (Zhou et al. 2008)";
}

std::vector<scene::SettingSpec> CompensatedRayMarchingGpu::settings() const {
  return compensated_ray_marching::CompensatedRayMarching().settings();
}

std::vector<std::string> CompensatedRayMarchingGpu::supports(const Scene& scene,
                                                             const scene::Settings& settings) const {
  return unsupported_on_device(scene, compensated_ray_marching::read_options(settings));
}

std::unique_ptr<scene::Prepared> CompensatedRayMarchingGpu::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                              const scene::Settings& settings,
                                                                              const Execution& execution) const {
  return std::make_unique<compensated_ray_marching::PreparedSequence<PreparedSmokeGpu>>(
      std::make_unique<PreparedSmokeGpu>(std::move(scene), compensated_ray_marching::read_options(settings),
                                         settings.canonical(), compensated_ray_marching::Solution{}, execution));
}

}  // namespace airlight::gpu
