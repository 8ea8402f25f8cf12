#include "methods/legendre_fluids/paper_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "methods/legendre_fluids/light_options.h"
#include "methods/legendre_fluids/lit_media.h"
#include "methods/legendre_fluids/paper_view.h"
#include "methods/legendre_fluids/point_values.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/light/scattered_lights.h"
#include "scene/picture.h"

namespace airlight::legendre_fluids {
namespace {

using Coefficients = std::array<Eigen::VectorXd, 3>;  // of the channels

class PreparedPaper final : public scene::Prepared {
 public:
  PreparedPaper(std::shared_ptr<const scene::Scene> scene, const PaperOptions& options, std::string settings)
      : options_(options), settings_(std::move(settings)) {
    times_ = prepare(std::move(scene));
  }
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const scene::View&, const scene::Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const scene::Scene>,
                                                    const scene::Execution&) override;

 private:
  // E_d of a light, 1 where it comes in.
  struct Direct {
    Coefficients of_channel;
    double negative = 0;  // greatest share of the box where it is below 0
  };
  std::vector<scene::StageTime> prepare(std::shared_ptr<const scene::Scene>);
  std::shared_ptr<const Direct> solve_direct(const scene::DirectionalLight&);
  bool scatters() const { return field_ && scene::why_nothing_scatters(*scene_).empty(); }
  bool behind_kept() const {
    return (scene_->geometry && !lights_.empty()) || scene::has_environment(*scene_) || !scene_->backdrops.empty();
  }
  bool ends() const { return scene_->geometry || behind_kept(); }
  Scattered scattered(const Vec3& direction) const;
  Rgb left_of_light(const Point3&, std::size_t light) const;
  // Where rays of a row end, and what they see there without the medium.
  void look(int y, const scene::CameraRays&, PaperView::Row&, std::vector<Rgb>& behind) const;

  std::shared_ptr<const scene::Scene> scene_;
  PaperOptions options_;
  std::string settings_;
  PaperMedium media_;
  const scene::Medium* medium_ = nullptr;  // the medium of media_
  scene::LegendrePointer field_;           // the density of media_; null where nothing extinguishes
  std::vector<scene::DirectionalLight> lights_;
  std::optional<PaperLight> light_;
  std::array<std::optional<DensityProduct>, 3> scatters_;  // of an albedo that is a field
  std::array<bool, 3> moving_;
  std::vector<std::shared_ptr<const Direct>> direct_;  // of each light
  int iterations_ = 0, direct_made_ = 0;               // for this frame; others are of frames before
  double negative_direct_ = 0, negative_density_ = 0;  // shares of the box
  std::vector<scene::StageTime> times_;
};

// Solves once for channels with equal extinction and copies the result.
template <class F>
void for_extinctions(const Rgb& sigma_t, Coefficients& all, const F& solve) {
  for (int c = 0; c < 3; ++c) {
    int same = 0;
    while (sigma_t[same] != sigma_t[c]) ++same;
    all[std::size_t(c)] = same < c ? all[std::size_t(same)] : solve(sigma_t[c]);
  }
}

// For a first scene, or one that keeps what the frame before has in common with it.
std::vector<scene::StageTime> PreparedPaper::prepare(std::shared_ptr<const scene::Scene> scene) {
  scene::Stopwatch watch;
  const std::shared_ptr<const scene::Scene> before = std::exchange(scene_, std::move(scene));
  const std::vector<scene::DirectionalLight> lights_before = std::exchange(lights_, {});
  const std::vector<std::shared_ptr<const Direct>> direct_before = std::exchange(direct_, {});
  const Rgb sigma_before = medium_ ? medium_->sigma_t : Rgb(Rgb::Zero());
  const std::array<bool, 3> moving_before = std::exchange(moving_, moving_axes(*scene_));
  for (const scene::Light& light : scene_->lights)
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light);
        sun && (scatter(scene_->media, light) || (scene_->geometry && scene::shines(light))))
      lights_.push_back(*sun);
  const std::optional<PaperMedium> kept =
      before && moving_ == moving_before ? kept_medium(media_, *before, *scene_) : std::nullopt;
  media_ = kept ? *kept : paper_medium(*scene_);
  medium_ = media_.medium;
  field_ = media_.density;
  iterations_ = direct_made_ = 0;
  if (!kept) {
    light_.reset();
    scatters_ = {};
    negative_density_ = 0;
  }
  if (!field_) return {};
  if (!kept) {
    light_.emplace(*field_, options_, moving_);
    for (std::size_t c = 0; c < 3 && media_.scattering[0]; ++c)
      scatters_[c].emplace(media_.scattering[c]->coefficients(), field_->shape(), light_->shape(), options_.truncation);
    if (field_->negative()) negative_density_ = negative_share(field_->shape(), field_->coefficients());
  }
  const bool keeps_direct = kept && (medium_->sigma_t == sigma_before).all();
  for (const scene::DirectionalLight& light : lights_) {
    std::size_t known = 0;
    while (known < lights_before.size() && lights_before[known].to_light != light.to_light) ++known;
    direct_.push_back(keeps_direct && known < direct_before.size() ? direct_before[known] : solve_direct(light));
  }
  negative_direct_ = 0;
  for (const auto& direct : direct_) negative_direct_ = std::max(negative_direct_, direct->negative);
  if (kept && direct_made_ == 0) return {};
  return {{lights_.empty() ? "operators" : "direct systems", watch.lap()}};
}

std::shared_ptr<const PreparedPaper::Direct> PreparedPaper::solve_direct(const scene::DirectionalLight& light) {
  auto direct = std::make_shared<Direct>();
  for_extinctions(medium_->sigma_t, direct->of_channel,
                  [&](double sigma) { return light_->direct(-light.to_light, sigma, &iterations_); });
  for (const Eigen::VectorXd& e : direct->of_channel)
    direct->negative = std::max(direct->negative, negative_share(light_->shape(), e));
  ++direct_made_;
  return direct;
}

std::optional<std::vector<scene::StageTime>> PreparedPaper::next(std::shared_ptr<const scene::Scene> scene,
                                                                 const scene::Execution&) {
  if (!unsupported_light(*scene, {LightOptions::Variant::paper, {}, options_}).empty()) return std::nullopt;
  return prepare(std::move(scene));
}

std::vector<scene::Stage> PreparedPaper::stages() const {
  const bool kept = scatters(), direct = field_ && !lights_.empty();
  const std::string why = kept || field_ ? scene::why_nothing_scatters(*scene_) : "no medium extinguishes";
  const std::string how = !field_ ? ""
                                  : fmt::format("{} of {} unknowns", options_.solver.dense ? "dense" : "GMRES",
                                                scene::tensor_size(light_->shape()));
  return {{"direct systems", direct, direct ? how : why},
          {"scattered systems", kept, kept ? how : why},
          {"albedo", bool(media_.scattering[0]),
           media_.scattering[0] ? "a field: of several densities in one box" : "the same everywhere"},
          {"image", kept, kept ? "coefficients of the faces towards the camera" : why},
          {"clamping", kept, kept ? "negative radiance is taken as 0" : why},
          {"transmittance", field_ && ends(),
           !field_  ? "no medium extinguishes"
           : ends() ? "exact along camera rays"
                    : "nothing is behind the medium"},
          {"surfaces", behind_kept(),
           behind_kept() ? "lights through the medium, backgrounds" : "no surface is lit, no background"}};
}

Scattered PreparedPaper::scattered(const Vec3& direction) const {
  Scattered all;
  if (!scatters()) return all;
  std::vector<double> omega;
  for (const scene::DirectionalLight& light : lights_)
    omega.push_back(phase_value(medium_->phase, std::clamp(direction.dot(-light.to_light), -1.0, 1.0)));
  std::array<Eigen::VectorXd, 3> shares;  // of the lights, the greatest is 1
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = Eigen::Index(c);
    shares[c].resize(Eigen::Index(lights_.size()));
    for (std::size_t l = 0; l < lights_.size(); ++l) shares[c][Eigen::Index(l)] = lights_[l].irradiance[channel];
    const double most = shares[c].maxCoeff(), sigma = medium_->sigma_t[channel];
    all.scale[channel] = (scatters_[c] ? 1 : medium_->albedo[channel]) * most;
    if (most > 0) shares[c] /= most;
    std::size_t same = 0;
    while (!media_.alike(same, c) || shares[same] != shares[c]) ++same;
    all.of_channel[c] = same < c ? all.of_channel[same] : all.series.size();
    if (same < c) continue;
    Eigen::VectorXd direct = shares[c][0] * omega[0] * direct_[0]->of_channel[c];
    for (std::size_t l = 1; l < lights_.size(); ++l)
      direct += shares[c][Eigen::Index(l)] * omega[l] * direct_[l]->of_channel[c];
    all.series.push_back(
        light_->scattered(direct, direction, sigma, sigma, scatters_[c] ? &*scatters_[c] : nullptr, &all.iterations));
  }
  return all;
}

// E_d where the light leaves the medium on its way there: a shadowgram on what lies behind.
Rgb PreparedPaper::left_of_light(const Point3& x, std::size_t light) const {
  const Ray ray{x, lights_[light].to_light};
  const Interval t = field_ ? scene::clip(field_->box(), ray, {0, infinity}) : Interval{1, 0};
  if (t.empty()) return Rgb::Ones();
  Rgb left;
  for (int c = 0; c < 3; ++c)
    left[c] = c > 0 && medium_->sigma_t[c] == medium_->sigma_t[0]
                  ? left[0]
                  : std::max(0.0, series_value(light_->shape(), direct_[light]->of_channel[std::size_t(c)].data(),
                                               field_->local(ray.at(t.lo))));
  return left;
}

void PreparedPaper::look(int y, const scene::CameraRays& rays, PaperView::Row& row, std::vector<Rgb>& behind) const {
  const bool kept = behind_kept();
  for (std::size_t x = 0; x < behind.size(); ++x) {
    const Ray ray = rays(double(x) + 0.5, y + 0.5);
    const scene::RayEnd end = scene::camera_end(*scene_, ray);
    row.end[x] = end.t;
    row.seen[x] = row.seen[x] || end.t < infinity || end.seen;
    if (row.seen[x] && kept)
      behind[x] = scene::end_radiance(*scene_, ray, end, lights_, [&](const scene::Incident&, std::size_t l) {
        return left_of_light(end.hit->position, l);
      });
  }
}

scene::Rendering PreparedPaper::render(const scene::View& view, const scene::Execution& execution) const {
  require_view(view, moving_);
  require_own_camera(*scene_, view);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  const auto wanted = [&](const char* name) { return !execution.layers || execution.layers->contains(name); };
  const bool transmittance = ends() && wanted("transmittance");
  const scene::PictureLayers layers(film, {wanted("airlight"), ends() && wanted("surface"), false, transmittance});
  film.metadata = {
      {"method", "legendre_fluids"}, {"settings", settings_}, {"scene", scene_->name}, {"hash", scene_->hash}};
  scene::Stopwatch watch;
  const Scattered scattered = this->scattered(-view.camera.forward);
  if (scatters()) result.times.push_back({"scattered systems", watch.lap()});
  std::optional<PaperView> medium;
  if (field_) medium.emplace(*field_, *light_, scattered, medium_->sigma_t, view, ends());
  const bool all_columns = transmittance || scene::has_environment(*scene_);
  const scene::CameraRays rays(view.camera, view.width, view.height);
  std::mutex mutex;
  long met = 0, negative = 0;
  scene::parallel_for(view.height, execution, [&](int y) {
    const auto width = std::size_t(view.width);
    PaperView::Row row;
    row.end.assign(width, infinity);
    row.seen.assign(width, all_columns);
    std::vector<Rgb> behind(width, Rgb::Zero());
    if (ends()) look(y, rays, row, behind);
    if (medium) medium->row(y, row);
    for (std::size_t x = 0; x < width; ++x) {
      scene::Pixel pixel;
      if (medium) pixel.airlight = row.airlight[x].max(0);
      if (medium && row.column[x] != 0) pixel.transmittance = (-medium_->sigma_t * row.column[x]).exp();
      pixel.surface = pixel.transmittance * behind[x];
      layers.put(int(x), y, pixel);
    }
    const std::lock_guard lock(mutex);
    met += row.met;
    negative += row.negative;
  });
  result.times.push_back({scatters() ? "image" : "camera rays", watch.lap()});
  result.counters["rays"] = double(film.pixels());
  if (!scatters()) return result;
  result.counters["unknowns"] = double(scene::tensor_size(light_->shape()));
  result.counters["direct_systems_made"] = double(direct_made_);
  result.counters["iterations"] = double(iterations_ + scattered.iterations);
  result.counters["negative_share"] = met > 0 ? double(negative) / double(met) : 0;
  result.counters["negative_direct_share"] = negative_direct_;
  result.counters["negative_density_share"] = negative_density_;
  return result;
}

}  // namespace

std::array<bool, 3> moving_axes(const scene::Scene& scene) {
  std::array<bool, 3> moving;
  for (int a = 0; a < 3; ++a) {
    const auto along = [&](const scene::Light& light) {
      const auto* sun = std::get_if<scene::DirectionalLight>(&light);
      return sun && sun->irradiance.maxCoeff() > 0 && sun->to_light[a] != 0;
    };
    moving[std::size_t(a)] =
        scene.camera.forward[a] != 0 || std::any_of(scene.lights.begin(), scene.lights.end(), along);
  }
  return moving;
}

void require_view(const scene::View& view, const std::array<bool, 3>& moving) {
  if (view.camera.kind != scene::Camera::Kind::orthographic) throw Error("variant = paper is for orthographic cameras");
  for (int a = 0; a < 3; ++a)
    if (view.camera.forward[a] != 0 && !moving[std::size_t(a)])
      throw Error("variant = paper: a view along an axis on which the scene's own does not move; prepare it anew");
}

namespace {

bool surface_may_shadow(const scene::Scene& scene, std::size_t medium) {
  const scene::LegendrePointer field =
      unsupported_field(scene.media, medium).empty() ? field_within_region(scene.media[medium]) : nullptr;
  for (const scene::Light& light : scene.lights)
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light); field && sun && sun->irradiance.maxCoeff() > 0)
      for (const scene::Surface& surface : scene.surfaces)
        if (may_shadow(surface, field->box(), sun->to_light)) return true;
  return false;
}

}  // namespace

std::vector<std::string> unsupported_paper(const scene::Scene& scene, const PaperOptions& options) {
  std::vector<std::string> reasons;
  if (scene.camera.kind != scene::Camera::Kind::orthographic)
    reasons.push_back("variant = paper has one image of a whole view: expected an orthographic camera");
  if ((scene.ambient_in_scatter > 0).any()) reasons.push_back("variant = paper knows no ambient_in_scatter");
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const std::string why = scene::unknown_light<scene::DirectionalLight, scene::EnvironmentLight>(scene.lights, i);
        !why.empty())
      reasons.push_back(why);
  int unknowns = 0;
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    if (!extinguishes(scene.media[i])) continue;
    if (surface_may_shadow(scene, i))
      reasons.push_back(
          "variant = paper knows no shadows within the medium: a surface may stand between it and a light");
    const auto* field = std::get_if<scene::LegendrePointer>(&scene.media[i].field);
    const scene::TensorShape of_density = field ? (*field)->shape() : scene::TensorShape{1, 1, 1};
    unknowns = std::max(unknowns, scene::tensor_size(intensity_shape(of_density, options.n, moving_axes(scene))));
    if (options.truncation == LightTruncation::chebyshev && field)
      for (const int n : (*field)->shape())
        if (n > options.n)
          reasons.push_back(
              fmt::format("truncation = chebyshev with n = {} intensity coefficients for the {} of {}, "
                          "expected no fewer",
                          options.n, n, scene::label(scene.media, i)));
  }
  if (const std::string why = several_against(scene); !why.empty()) reasons.push_back(why);
  if (options.solver.dense && unknowns > LightSystem::most_dense)
    reasons.push_back(
        fmt::format("n = {}: a dense system of {} unknowns, expected at most {}; closure = upwind has "
                    "solver = gmres",
                    options.n, unknowns, LightSystem::most_dense));
  if (options.solver.closure == Closure::least_squares && !options.solver.dense)
    reasons.push_back("solver = gmres is for closure = upwind");
  if (options.solver.closure == Closure::upwind && options.truncation == LightTruncation::chebyshev)
    reasons.push_back("closure = upwind needs truncation = l2, which leaves it definite");
  return reasons;
}

std::unique_ptr<scene::Prepared> prepare_paper(std::shared_ptr<const scene::Scene> scene, const PaperOptions& options,
                                               const std::string& settings) {
  return std::make_unique<PreparedPaper>(std::move(scene), options, settings);
}

}  // namespace airlight::legendre_fluids
