#include "methods/legendre_fluids/ray_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/stopwatch.h"
#include "scene/light/scattered_lights.h"
#include "scene/picture.h"

namespace airlight::legendre_fluids {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

class PreparedRays final : public scene::Prepared {
 public:
  PreparedRays(std::shared_ptr<const Scene> scene, const RayOptions& options, std::string settings)
      : options_(options), settings_(std::move(settings)) {
    times_ = prepare(std::move(scene));
  }
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;

 private:
  std::vector<scene::StageTime> prepare(std::shared_ptr<const Scene>);
  const LightRays& rays() const { return *rays_; }
  bool ends() const { return scene_->geometry || !scene_->backdrops.empty(); }
  bool any_medium() const { return !rays().media().media.empty(); }
  bool scatters() const {
    const auto scattering = [](const LitMedium& m) { return (m.medium->albedo * m.medium->sigma_t).maxCoeff() > 0; };
    const LitMedia& lit = rays().media();
    return !lit.lights.empty() && std::any_of(lit.media.begin(), lit.media.end(), scattering);
  }
  bool behind_kept() const {
    return (scene_->geometry && !rays().media().lights.empty()) || scene::has_environment(*scene_) ||
           !scene_->backdrops.empty();
  }
  bool ambient_kept() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && any_medium(); }
  scene::Pixel pixel(const Ray&, RayVisits&) const;

  std::shared_ptr<const Scene> scene_;
  RayOptions options_;
  std::string settings_;
  std::optional<LightRays> rays_;
  std::vector<scene::StageTime> times_;
  double negative_ = 0;  // greatest share of a box
};

// For a first scene, or one that shares with the frame before what has not changed.
std::vector<scene::StageTime> PreparedRays::prepare(std::shared_ptr<const Scene> scene) {
  scene::Stopwatch watch;
  scene = with_sky(std::move(scene), options_);
  LightRays rays(*scene, options_, rays_ ? &*rays_ : nullptr);
  negative_ = rays.negative_share();
  rays_ = std::move(rays);
  scene_ = std::move(scene);
  const double seconds = watch.lap();
  if (rays_->columns_made() == 0) return {};
  return {{"columns", seconds}};
}

std::optional<std::vector<scene::StageTime>> PreparedRays::next(std::shared_ptr<const Scene> scene, const Execution&) {
  if (!unsupported_light(*scene, {LightOptions::Variant::ray, options_, {}}).empty()) return std::nullopt;
  return prepare(std::move(scene));
}

std::vector<scene::Stage> PreparedRays::stages() const {
  const LitMedia& lit = rays().media();
  int polynomials = 0, faces = 0;
  for (const LitMedium& m : lit.media)
    for (const auto& columns : m.columns) polynomials += columns->polynomials(), faces += columns->face_count();
  const std::string dark = scene::why_nothing_scatters(*scene_);
  const std::string why = !any_medium() ? "no medium extinguishes" : dark.empty() ? "no medium scatters" : dark;
  return {{"polynomials of light paths", polynomials > 0,
           lit.media.empty() || lit.lights.empty() ? why
                                                   : fmt::format("of {} of {} faces that light comes in by; the others "
                                                                 "are integrated by Gauss points",
                                                                 polynomials, faces)},
          {"clamping", negative_ > 0,
           negative_ > 0 ? fmt::format("a density is below 0 in {:.2g} of its box, and taken as 0", negative_)
                         : "no density is below 0"},
          {"airlight", scatters(),
           scatters() ? fmt::format("{} points on panels, tolerance {:g}", options_.points, options_.tolerance) : why},
          {"shadows", scatters() && rays().shadowed(),
           rays().shadowed() ? "surfaces may stand before a light" : "no surface stands before a light"},
          {"transmittance", any_medium(), any_medium() ? "exact along camera rays" : why},
          {"surfaces", behind_kept(),
           behind_kept() ? "lights through the media, backgrounds" : "no surface is lit, no background"},
          {"ambient", ambient_kept(),
           ambient_kept() ? "ambient_in_scatter times 1 - transmittance" : "ambient_in_scatter is zero, or no medium"},
          {"environment as a light", scene::has_environment(*scene_) && !lit.lights.empty(),
           !scene::has_environment(*scene_) ? "no environment"
           : lit.lights.empty()             ? "nothing scatters, no surface is lit: only the background is drawn"
                                            : fmt::format("{} directions", options_.environment_directions)}};
}

scene::Pixel PreparedRays::pixel(const Ray& ray, RayVisits& visits) const {
  scene::Pixel pixel;
  const scene::RayEnd end = ends() ? scene::camera_end(*scene_, ray) : scene::RayEnd{};
  const Rgb depth = rays().media().view_depth(ray, end.t);
  pixel.transmittance = (-depth).exp();
  if (scatters()) pixel.airlight = rays().airlight(ray, end.t, visits);
  if (behind_kept() && pixel.transmittance.maxCoeff() > 0)
    pixel.surface =
        pixel.transmittance * scene::end_radiance(*scene_, ray, end, rays().media().lights,
                                                  [&](const scene::Incident&, std::size_t l) -> Rgb {
                                                    return (-rays().media().light_depth(end.hit->position, l)).exp();
                                                  });
  // 1 - exp(-depth) without cancelling: thin fog has a depth of 1e-8.
  if (ambient_kept())
    pixel.ambient = scene_->ambient_in_scatter * depth.unaryExpr([](double d) { return -std::expm1(-d); });
  return pixel;
}

scene::Rendering PreparedRays::render(const View& view, const Execution& execution) const {
  require_own_camera(*scene_, view);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  scene::Film& film = result.film;
  const scene::PictureLayers layers(film, {.ambient = ambient_kept()});
  film.metadata = {
      {"method", "legendre_fluids"}, {"settings", settings_}, {"scene", scene_->name}, {"hash", scene_->hash}};
  if (scene::has_environment(*scene_) && !rays().media().lights.empty())
    film.metadata["warning"] =
        fmt::format("legendre_fluids: {} directional lights stand for each environment (environment_directions)",
                    options_.environment_directions);
  scene::Stopwatch watch;
  const auto total = scene::draw_pixels<RayVisits>(
      view, execution, layers, [&](const Ray& ray, RayVisits& visits) { return pixel(ray, visits); });
  result.times.push_back({"rays", watch.lap()});
  result.counters = {{"rays", double(film.pixels())},
                     {"segments", double(total.segments)},
                     {"panels", double(total.work.panels)},
                     {"points", double(total.work.panels) * options_.points},
                     {"shadow_rays", double(total.shadow_rays)},
                     {"columns_made", double(rays().columns_made())},
                     {"negative_share", negative_}};
  return result;
}

}  // namespace

std::unique_ptr<scene::Prepared> prepare_rays(std::shared_ptr<const Scene> scene, const RayOptions& options,
                                              const std::string& settings) {
  return std::make_unique<PreparedRays>(std::move(scene), options, settings);
}

}  // namespace airlight::legendre_fluids
