#include "methods/compensated_ray_marching/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/compensated_ray_marching/centre_sources.h"
#include "methods/compensated_ray_marching/lit_grid.h"
#include "methods/compensated_ray_marching/smoke_volume.h"
#include "methods/compensated_ray_marching/warm_start.h"
#include "scene/base/stopwatch.h"
#include "scene/light/scattered_lights.h"
#include "scene/math/special_functions.h"
#include "scene/picture.h"

namespace airlight::compensated_ray_marching {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

struct Work {
  long slices = 0, samples = 0;
  void operator+=(const Work& more) {
    slices += more.slices;
    samples += more.samples;
  }
};

// Most media are grey: one expensive function instead of three.
Rgb one_minus_exp(const Rgb& x) {
  const double first = -std::expm1(-x[0]);
  return {first, x[1] == x[0] ? first : -std::expm1(-x[1]), x[2] == x[0] ? first : -std::expm1(-x[2])};
}

// Four at a time: arrays of three are not vectorised.
Rgb exponentials(const Rgb& x) {
  const Eigen::Array4d all = Eigen::Array4d(x[0], x[1], x[2], 0).exp();
  return all.head<3>();
}

class PreparedPicture final : public scene::Prepared {
 public:
  // Iterations begin with the last solution, if there is one.
  PreparedPicture(std::shared_ptr<const Scene>, const Options&, std::string settings, Solution last, const Execution&);
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;
  std::unique_ptr<PreparedPicture> in_other_smoke(std::shared_ptr<const Scene>, const Execution&) const;

 private:
  bool paper() const { return options_.variant == Options::Variant::paper; }
  std::vector<scene::StageTime> light(const Execution&);
  // Whether the picture contains multiple scattering.
  bool multiple() const { return scatters_ && (grid_ ? grid_->single_only() : centres_->single_only()).empty(); }
  bool ends() const { return scene_->geometry || !scene_->backdrops.empty(); }
  bool behind_kept() const { return scene_->geometry || scene::has_environment(*scene_) || !scene_->backdrops.empty(); }
  bool ambient_kept() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && smoke_; }
  scene::Pixel pixel(const Ray&, const View&, const GaussianRow*, const SmokeVolume::Values&,
                     const std::vector<Rgb>& towards, std::vector<double>& density, std::vector<Rgb>& weighted,
                     Work&) const;
  Rgb behind(const Ray&, const scene::RayEnd&) const;

  std::shared_ptr<const Scene> scene_;
  std::string lit_by_ = scene_->light_hash;         // what the last frame was lit by
  std::vector<std::shared_ptr<const Scene>> kept_;  // of the frames before: the one whose smoke is marched through
  Options options_;
  std::string settings_;
  std::optional<SmokeField> smoke_;  // nothing where no medium extinguishes
  bool scatters_ = false;            // the smoke, something of the light
  double slice_ = 0;                 // [m] across
  std::optional<IncomingLight> incoming_;
  std::optional<LitGrid> grid_;
  std::optional<CentreSources> centres_;
  std::optional<SmokeVolume> volume_;  // of paper through fitted smoke
  Solution last_;                      // of a frame before, where this one has none
  std::vector<scene::StageTime> times_;
};

PreparedPicture::PreparedPicture(std::shared_ptr<const Scene> scene, const Options& options, std::string settings,
                                 Solution last, const Execution& execution)
    : scene_(std::move(scene)), options_(options), settings_(std::move(settings)), last_(std::move(last)) {
  for (const scene::Medium& medium : scene_->media)
    if (extinguishes(medium) && !smoke_box(medium).empty()) smoke_.emplace(medium, options_);
  scatters_ = smoke_ && scene::why_nothing_scatters(*scene_).empty();
  scene::Stopwatch watch;
  if (!paper()) {
    incoming_.emplace(scene_->lights, EnvironmentBands(options_.grid.levels));
    times_.push_back({"environment", watch.lap()});
  }
  static const scene::GaussianSum no_smoke;
  static const scene::Medium clear;
  if (paper() && !smoke_) centres_.emplace(no_smoke, clear, scene_->surfaces, options_);
  if (!smoke_) {
    light(execution);
    return;
  }
  slice_ = smoke_box(smoke_->medium()).size().maxCoeff() / options_.slices;
  if (paper()) {
    centres_.emplace(smoke_->centres(), smoke_->medium(), scene_->surfaces, options_);
    centres_->begin_with(last_);
    if (smoke_->voxels()) {
      watch.lap();
      volume_.emplace(*smoke_, execution);
      times_.push_back({"densities", watch.lap()});
    }
  } else if (scatters_) {
    grid_.emplace(*scene_, smoke_->medium(), options_, *incoming_, execution);
    grid_->begin_with(last_, incoming_->grey());
    times_.insert(times_.end(), grid_->times().begin(), grid_->times().end());
  }
  const std::vector<scene::StageTime> lit = light(execution);
  times_.insert(times_.end(), lit.begin(), lit.end());
  if (multiple()) last_ = {};
}

std::vector<scene::StageTime> PreparedPicture::light(const Execution& execution) {
  if (centres_) {
    centres_->light(scene_->lights, scatters_, execution);
    return centres_->times();
  }
  if (!grid_) return {};
  grid_->light(*incoming_, execution);
  return grid_->times();
}

// Lights alone: the smoke, its depths and the last multiple scattering are kept. Where only the camera moved, all of it is.
std::optional<std::vector<scene::StageTime>> PreparedPicture::next(std::shared_ptr<const Scene> scene,
                                                                   const Execution& execution) {
  if (scene->matter_hash != scene_->matter_hash || !unsupported(*scene, options_).empty() ||
      (incoming_ && !incoming_->fits(scene->lights)) ||
      (smoke_ && !scatters_ && scene::why_nothing_scatters(*scene).empty()))
    return std::nullopt;
  const bool lit = !scene->light_hash.empty() && scene->light_hash == lit_by_;
  lit_by_ = scene->light_hash;
  kept_.push_back(std::exchange(scene_, std::move(scene)));
  kept_.resize(1);  // the first, whose smoke is marched through
  if (lit) return std::vector<scene::StageTime>{};
  std::vector<scene::StageTime> times;
  if (incoming_) {
    scene::Stopwatch watch;
    incoming_->become(scene_->lights);
    times.push_back({"environment", watch.lap()});
  }
  const std::vector<scene::StageTime> of_light = light(execution);
  times.insert(times.end(), of_light.begin(), of_light.end());
  return times;
}

// Without a solution nothing is kept: then the next frame is prepared anew. A frame without smoke passes on what it was given.
std::unique_ptr<PreparedPicture> PreparedPicture::in_other_smoke(std::shared_ptr<const Scene> scene,
                                                                 const Execution& execution) const {
  Solution now = grid_ ? grid_->solution() : centres_ ? centres_->solution() : Solution{};
  if (now.empty()) now = last_;
  if (now.empty() || !unsupported(*scene, options_).empty()) return nullptr;
  return std::make_unique<PreparedPicture>(std::move(scene), options_, settings_, std::move(now), execution);
}

std::vector<scene::Stage> PreparedPicture::stages() const {
  const std::string none = "no medium extinguishes";
  const std::string dark = smoke_ ? scene::why_nothing_scatters(*scene_) : none;
  std::string how, again, march;
  if (grid_) {
    const auto& size = grid_->grid().cells.size;
    how = fmt::format("{} of {} x {} x {} nodes, {} directions", grid_->nodes_with_smoke(), size[0], size[1], size[2],
                      incoming_->directions().size());
    again = grid_->single_only();
    if (again.empty())
      again = fmt::format("{} bands, deepest cell {:.2g}; {} iterations, error about {:.1g}{}", options_.order,
                          grid_->deepest_cell(), grid_->iterations(), grid_->error(),
                          grid_->error() > options_.tolerance ? ": more than the tolerance" : "");
  } else if (centres_) {
    how = fmt::format("{} centres, {} bands", centres_->sources().size(), options_.order);
    again = centres_->single_only();
    if (again.empty())
      again = fmt::format("{} iterations, residual {:.1g}", centres_->iterations(), centres_->residual());
  }
  return {
      {"single scattering", scatters_, scatters_ ? how : dark},
      {"multiple scattering", multiple(), scatters_ ? again : dark},
      {"residual", smoke_ && smoke_->with_residual(),
       !smoke_                   ? none
       : smoke_->with_residual() ? fmt::format("added to the Gaussians, from {}", smoke_->residual()->name())
       : paper()                 ? "the Gaussians are all"
                                 : "the field itself is marched through"},
      {"volume pass", volume_.has_value(),
       volume_ ? fmt::format("density and source at {} x {} x {} voxels", smoke_->voxels()->size[0],
                             smoke_->voxels()->size[1], smoke_->voxels()->size[2])
               : "no Gaussians with voxels of variant = paper"},
      {"march", smoke_.has_value(), !smoke_ ? none : fmt::format("slices of {:.3g} m", slice_)},
      {"surfaces", behind_kept(),
       !behind_kept() ? "nothing stands behind"
       : paper() && scene_->geometry
           ? fmt::format("what stands behind, through the smoke; {} spheres cast shadows, those of meshes among them"
                         "; planes none",
                         centres_->objects())
           : "what stands behind, through the smoke"},
      {"ambient", ambient_kept(),
       ambient_kept() ? "ambient_in_scatter times 1 - transmittance" : "ambient_in_scatter is zero, or no medium"}};
}

// Radiance from the end of the ray, without the smoke in between. Light that the smoke scatters onto
// surfaces is left out.
Rgb PreparedPicture::behind(const Ray& ray, const scene::RayEnd& end) const {
  if (!end.hit) return scene::background(*scene_, end, ray.direction);
  const scene::Hit& hit = *end.hit;
  if (centres_)  // of Lambert's
    return scene::brdf(scene_->surfaces[std::size_t(hit.surface)].material, hit.normal, hit.normal, hit.normal) *
           centres_->irradiance(hit.position, hit.normal, hit.surface);
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 0; k < incoming_->directions().size(); ++k) {
    const Vec3& to_light = incoming_->directions()[k];
    const Rgb reflected =
        scene::reflected_light(*scene_, hit, -ray.direction, {to_light, infinity, incoming_->power()[k]});
    if ((reflected == 0).all()) continue;
    const double column = smoke_ ? density_integral(smoke_->medium(), {hit.position, to_light}, {0, infinity}) : 0;
    sum += smoke_ ? Rgb(reflected * (-smoke_->medium().sigma_t * column).exp()) : reflected;
  }
  return sum.max(0);
}

scene::Pixel PreparedPicture::pixel(const Ray& ray, const View& view, const GaussianRow* row,
                                    const SmokeVolume::Values& voxels, const std::vector<Rgb>& towards,
                                    std::vector<double>& density, std::vector<Rgb>& weighted, Work& work) const {
  scene::Pixel p;
  const scene::RayEnd end = ends() ? scene::camera_end(*scene_, ray) : scene::RayEnd{};
  const Interval t = row ? row->extent(ray, {0, end.t}) : smoke_ ? smoke_->extent(ray, {0, end.t}) : Interval{};
  if (!t.empty()) {
    const double slope = std::max(ray.direction.dot(view.camera.forward), 1e-3);
    RaySlices slices{t.lo, 0, std::max(1, int(std::ceil(t.length() * slope / slice_)))};
    slices.step = t.length() / slices.count;
    density.assign(std::size_t(slices.count), 0.0);
    weighted.assign(centres_ && row ? density.size() : 0, Rgb::Zero());
    // Near to far, with the transmittance so far: the paper's sum, which goes from far to near. Slices are the ray's own, at most slice_ thick,
    // where the paper has common planes.
    // At hard edges interpolation between nodes may overshoot; smoke is no brighter than the light it scatters.
    const Rgb brightest = grid_ && has_hard_edges(smoke_->medium())
                              ? Rgb(smoke_->medium().albedo * incoming_->brightest())
                              : Rgb(Rgb::Constant(infinity));
    const bool exact = options_.weight == SliceWeight::exact;
    if (row) work.samples += row->add(ray, slices, density.data(), centres_ ? weighted.data() : nullptr);
    for (int k = 0; k < slices.count; ++k) {
      const Point3 x = ray.at(slices.middle(k));
      const double of_gaussians = density[std::size_t(k)];
      const SmokeVolume::Sample voxel = volume_ ? volume_->between(voxels, x) : SmokeVolume::Sample{};
      const double here = volume_ ? voxel.density : smoke_->density(x, of_gaussians);
      if (!(here > 0)) continue;
      ++work.slices;
      const Rgb depth = smoke_->medium().sigma_t * here * slices.step, lost = one_minus_exp(depth);
      Rgb source = Rgb::Zero();
      if (!scatters_) {
        p.transmittance *= 1 - lost;
        continue;
      }
      if (grid_)  // nodes hold logarithms
        source = exponentials(between_nodes(grid_->grid(), towards, x)).min(brightest);
      else if (volume_)
        source = voxel.source;
      else if (of_gaussians >= smoke_->least_density())
        source = (weighted[std::size_t(k)] / of_gaussians).max(0);
      // With exact weights a slice shows as much of its source as it absorbs.
      p.airlight += p.transmittance * source * (exact ? lost : seen(depth, slope, options_.weight));
      p.transmittance *= 1 - lost;
    }
  }
  if (behind_kept() && p.transmittance.maxCoeff() > 0) p.surface = p.transmittance * behind(ray, end);
  if (ambient_kept()) p.ambient = scene_->ambient_in_scatter * (1 - p.transmittance);
  return p;
}

scene::Rendering PreparedPicture::render(const View& view, const Execution& execution) const {
  require_own_camera(*scene_, view);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  film.metadata = {
      {"method", "compensated_ray_marching"}, {"settings", settings_}, {"scene", scene_->name}, {"hash", scene_->hash}};
  if (const std::string doubt = doubt_of(*scene_, options_, multiple()); !doubt.empty())
    film.metadata["warning"] = "compensated_ray_marching: " + doubt;
  const scene::PictureLayers layers(film, {.ambient = ambient_kept()});
  scene::Stopwatch watch;
  std::vector<Rgb> towards;
  if (grid_) towards = grid_->towards(view.camera, execution);
  if (centres_) towards = centres_->towards(view.camera);
  if (scatters_) result.times.push_back({"towards the camera", watch.lap()});
  SmokeVolume::Values voxels;
  if (volume_) {
    voxels = volume_->values(towards, execution);
    result.times.push_back({"volume pass", watch.lap()});
  }
  const scene::CameraRays rays(view.camera, view.width, view.height);
  const auto work = scene::parallel_sum<Work>(view.height, execution, [&](int y, Work& of_row) {
    std::vector<double> density;
    std::vector<Rgb> weighted;
    std::optional<GaussianRow> row;
    if (smoke_ && smoke_->gaussians()) {
      // The plane of the row's rays.
      const Ray first = rays(0, y + 0.5), last = rays(view.width, y + 0.5);
      const Vec3 across = (last.origin + last.direction - first.origin - first.direction);
      row.emplace(*smoke_->gaussians(), centres_ ? &towards : nullptr, first.origin,
                  first.direction.cross(across).normalized());
    }
    for (int x = 0; x < view.width; ++x)
      layers.put(
          x, y, pixel(rays(x + 0.5, y + 0.5), view, row ? &*row : nullptr, voxels, towards, density, weighted, of_row));
  });
  result.times.push_back({smoke_ ? "march" : "camera rays", watch.lap()});
  result.counters = {
      {"rays", double(film.pixels())}, {"slices", double(work.slices)}, {"gaussian_samples", double(work.samples)}};
  if (grid_) {
    result.counters["iterations"] = grid_->iterations();
    result.counters["multiple_error"] = grid_->error();
    result.counters["deepest_cell"] = grid_->deepest_cell();
  }
  if (centres_) {
    result.counters["iterations"] = centres_->iterations();
    result.counters["multiple_error"] = centres_->residual();
    result.counters["negative_share"] = centres_->negative_share();
  }
  return result;
}

}  // namespace

std::unique_ptr<scene::Prepared> prepare_picture(std::shared_ptr<const Scene> scene, const Options& options,
                                                 std::string settings, const Execution& execution) {
  return std::make_unique<PreparedSequence<PreparedPicture>>(
      std::make_unique<PreparedPicture>(std::move(scene), options, std::move(settings), Solution{}, execution));
}

}  // namespace airlight::compensated_ray_marching
