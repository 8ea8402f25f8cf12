#include "methods/legendre_fluids/paper_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "methods/legendre_fluids/lit_media.h"
#include "methods/legendre_fluids/point_values.h"
#include "scene/camera_rays.h"
#include "scene/error.h"
#include "scene/stopwatch.h"

namespace airlight::legendre_fluids {
namespace {

using Coefficients = std::array<Eigen::VectorXd, 3>;  // of the channels

// E_s of all lights together where the camera looks: everywhere, and on the three faces of the box that it may see.
struct Scattered {
  Coefficients everywhere;
  std::array<Coefficients, 3> face;
  int iterations = 0;
};

class PreparedPaper final : public scene::Prepared {
 public:
  PreparedPaper(std::shared_ptr<const scene::Scene>, const PaperOptions&, std::string settings);
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const scene::View&, const scene::Execution&) const override;

 private:
  Scattered scattered(const Vec3& direction) const;
  // Radiance that leaves towards the camera; false where the ray misses the box.
  bool radiance(const Scattered&, const Ray&, Rgb&) const;

  std::shared_ptr<const scene::Scene> scene_;
  PaperOptions options_;
  std::string settings_;
  const scene::Medium* medium_ = nullptr;
  scene::LegendrePointer field_;  // null where nothing extinguishes
  std::vector<scene::DirectionalLight> lights_;
  std::optional<PaperLight> light_;
  std::array<bool, 3> moving_;
  std::vector<Coefficients> direct_;  // E_d of each light, 1 where it comes in
  int iterations_ = 0;
  double negative_direct_ = 0;
  std::vector<scene::StageTime> times_;
};

// Of channels with the same extinction only the first is solved.
template <class F>
void for_extinctions(const Rgb& sigma_t, Coefficients& all, const F& solve) {
  for (int c = 0; c < 3; ++c) {
    int same = 0;
    while (sigma_t[same] != sigma_t[c]) ++same;
    all[std::size_t(c)] = same < c ? all[std::size_t(same)] : solve(sigma_t[c]);
  }
}

PreparedPaper::PreparedPaper(std::shared_ptr<const scene::Scene> scene, const PaperOptions& options,
                             std::string settings)
    : scene_(std::move(scene)), options_(options), settings_(std::move(settings)), moving_(moving_axes(*scene_)) {
  scene::Stopwatch watch;
  for (const scene::Light& light : scene_->lights)
    if (const auto& sun = std::get<scene::DirectionalLight>(light); sun.irradiance.maxCoeff() > 0)
      lights_.push_back(sun);
  for (const scene::Medium& medium : scene_->media)
    if (extinguishes(medium)) medium_ = &medium;
  if (medium_) field_ = field_within_region(*medium_);
  if (!field_) return;
  light_.emplace(*field_, options_, moving_);
  for (const scene::DirectionalLight& light : lights_) {
    direct_.emplace_back();
    for_extinctions(medium_->sigma_t, direct_.back(),
                    [&](double sigma) { return light_->direct(-light.to_light, sigma, &iterations_); });
    for (const Eigen::VectorXd& e : direct_.back())
      negative_direct_ = std::max(negative_direct_, negative_share(light_->shape(), e));
  }
  times_ = {{"direct systems", watch.lap()}};
}

std::vector<scene::Stage> PreparedPaper::stages() const {
  const bool kept = field_ && !lights_.empty();
  const std::string why = !field_ ? "no medium extinguishes" : "no directional light shines";
  const std::string how = !field_ ? ""
                                  : fmt::format("{} of {} unknowns", options_.solver.dense ? "dense" : "GMRES",
                                                scene::tensor_size(light_->shape()));
  return {{"direct systems", kept, kept ? how : why},
          {"scattered systems", kept, kept ? how : why},
          {"image", kept, kept ? "coefficients of the faces towards the camera" : why},
          {"clamping", kept, kept ? "negative radiance is taken as 0" : why}};
}

Scattered PreparedPaper::scattered(const Vec3& direction) const {
  Scattered all;
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    const double omega = phase_value(medium_->phase, std::clamp(direction.dot(-lights_[l].to_light), -1.0, 1.0));
    int channel = 0;
    Coefficients of_light;
    std::array<const Eigen::VectorXd*, 3> direct{&direct_[l][0], &direct_[l][1], &direct_[l][2]};
    for_extinctions(medium_->sigma_t, of_light, [&](double sigma) {
      while (medium_->sigma_t[channel] != sigma) ++channel;
      return light_->scattered(*direct[std::size_t(channel)], direction, sigma, sigma * omega, &all.iterations);
    });
    for (std::size_t c = 0; c < 3; ++c) {
      const double scale = medium_->albedo[Eigen::Index(c)] * lights_[l].irradiance[Eigen::Index(c)];
      of_light[c] *= scale;
      all.everywhere[c] = l == 0 ? of_light[c] : Eigen::VectorXd(all.everywhere[c] + of_light[c]);
    }
  }
  for (int a = 0; a < 3; ++a)
    for (std::size_t c = 0; c < 3; ++c)
      all.face[std::size_t(a)][c] = light_->on_face(all.everywhere[c], a, direction[a] > 0 ? 1 : -1);
  return all;
}

bool PreparedPaper::radiance(const Scattered& scattered, const Ray& ray, Rgb& radiance) const {
  const Interval t = scene::clip(field_->box(), ray, {0, infinity});
  if (t.empty()) return false;
  const Vec3 x = field_->local(ray.at(t.lo));
  int axis = 0;
  x.cwiseAbs().maxCoeff(&axis);
  // A camera within the box: E_s there is what arrives.
  const bool on_face = t.lo > 0;
  const Coefficients& from = on_face ? scattered.face[std::size_t(axis)] : scattered.everywhere;
  scene::TensorShape shape = light_->shape();
  if (on_face) shape[std::size_t(axis)] = 1;
  for (int c = 0; c < 3; ++c) {
    const bool same = c > 0 && from[std::size_t(c)] == from[0];
    radiance[c] = same ? radiance[0] : series_value(shape, from[std::size_t(c)].data(), x);
  }
  return true;
}

scene::Rendering PreparedPaper::render(const scene::View& view, const scene::Execution& execution) const {
  require_view(view, moving_);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  float *mean = film.add("mean").data(), *airlight = film.add("airlight").data();
  film.metadata = {
      {"method", "legendre_fluids"}, {"settings", settings_}, {"scene", scene_->name}, {"hash", scene_->hash}};
  if (!field_ || lights_.empty()) return result;
  scene::Stopwatch watch;
  const Scattered scattered = this->scattered(-view.camera.forward);
  result.times.push_back({"scattered systems", watch.lap()});
  const scene::CameraRays rays(view.camera, view.width, view.height);
  std::mutex mutex;
  long hits = 0, negative = 0;
  scene::parallel_rows(view.height, execution, [&](int y) {
    long row_hits = 0, row_negative = 0;
    for (int x = 0; x < view.width; ++x) {
      Rgb value;
      if (!radiance(scattered, rays(x + 0.5, y + 0.5), value)) continue;
      ++row_hits;
      if (value.minCoeff() < 0) ++row_negative;
      const std::size_t at = 3 * (std::size_t(y) * std::size_t(view.width) + std::size_t(x));
      for (int c = 0; c < 3; ++c)
        mean[at + std::size_t(c)] = airlight[at + std::size_t(c)] = float(std::max(0.0, value[c]));
    }
    const std::lock_guard lock(mutex);
    hits += row_hits;
    negative += row_negative;
  });
  result.times.push_back({"image", watch.lap()});
  result.counters = {{"rays", double(film.pixels())},
                     {"unknowns", double(scene::tensor_size(light_->shape()))},
                     {"iterations", double(iterations_ + scattered.iterations)},
                     {"negative_share", hits > 0 ? double(negative) / double(hits) : 0},
                     {"negative_direct_share", negative_direct_},
                     {"negative_density_share", negative_share(field_->shape(), field_->coefficients())}};
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

std::vector<std::string> reasons_against_paper(const scene::Scene& scene, const PaperOptions& options) {
  std::vector<std::string> reasons;
  if (scene.camera.kind != scene::Camera::Kind::orthographic)
    reasons.push_back("variant = paper has one image of a whole view: expected an orthographic camera");
  if (!scene.surfaces.empty()) reasons.push_back("variant = paper knows no surfaces");
  if ((scene.ambient_in_scatter > 0).any()) reasons.push_back("variant = paper knows no ambient_in_scatter");
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const std::string why = scene::unknown_light<scene::DirectionalLight>(scene.lights, i); !why.empty())
      reasons.push_back(why);
  std::size_t media = 0;
  int unknowns = 0;
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    if (!extinguishes(scene.media[i])) continue;
    ++media;
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
  if (media > 1) reasons.push_back(fmt::format("variant = paper with {} media, expected one", media));
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
