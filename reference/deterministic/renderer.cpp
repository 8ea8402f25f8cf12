#include "reference/deterministic/renderer.h"

#include <fmt/format.h>

#include "reference/deterministic/airlight.h"
#include "reference/deterministic/limits.h"
#include "scene/base/error.h"
#include "scene/base/place_error.h"
#include "scene/base/stopwatch.h"
#include "scene/picture.h"

namespace airlight::deterministic {
namespace {

using scene::Scene;
using scene::SettingSpec;

void bind(scene::SettingBinder& b, Accuracy& a) {
  b.real("relative_tolerance", a.relative_tolerance, 1e-14, 0.1, "of each pixel's airlight, per channel");
  b.integer("max_evaluations", a.max_evaluations, 15, 1e7, "of the integrand, per pixel");
}

const char* const no_finite_answer =
    "a point or spot light of radius 0 sits on the camera inside a medium: its airlight is infinite";

bool any_scattering(const Scene& scene) {
  for (const scene::Medium& m : scene.media)
    if ((m.sigma_t * m.albedo).maxCoeff() > 0) return true;
  return false;
}

bool any(const Scene& scene, bool delta) {
  for (const scene::Light& light : scene.lights)
    if (scene::is_delta(light) == delta) return true;
  return false;
}

struct Counts {
  long rays = 0, evaluations = 0, unmet = 0, infinite = 0;
  void operator+=(const Counts& more) {
    rays += more.rays;
    evaluations += more.evaluations;
    unmet += more.unmet;
    infinite += more.infinite;
  }
};

class DeterministicPrepared final : public scene::Prepared {
 public:
  DeterministicPrepared(std::shared_ptr<const Scene> scene, const scene::Settings& settings)
      : scene_(std::move(scene)),
        settings_(settings.canonical()),
        integrator_(*scene_, scene::read_settings(bind, settings)) {}

  std::vector<scene::Stage> stages() const override {
    const bool delta = any(*scene_, true), scattering = any_scattering(*scene_);
    const bool environment = any(*scene_, false);
    std::vector<scene::Stage> stages;
    stages.push_back({"airlight", airlight_kept(),
                      !delta        ? "no point, spot or directional light"
                      : !scattering ? "no medium scatters"
                                    : "order (1, 0) from delta lights by quadrature"});
    stages.push_back({"shadows", airlight_kept() && scene_->geometry,
                      scene_->geometry ? "surfaces cast shadows into the medium" : "no surfaces"});
    stages.push_back({"surface", surface_kept(),
                      surface_kept() ? "surfaces under delta lights, background" : "neither surfaces nor background"});
    stages.push_back({"ambient", ambient_kept(),
                      ambient_kept() ? "ambient_in_scatter times 1 - transmittance" : "ambient_in_scatter is zero"});
    if (environment)
      stages.push_back({"environment as a light", false,
                        "not a delta light: only the background is drawn, see the path tracer for the rest"});
    stages.push_back({"higher orders", false, "this reference computes orders (1, 0) and (0, 1) only"});
    return stages;
  }

  scene::Rendering render(const scene::View& view, const scene::Execution& execution) const override {
    require_own_camera(*scene_, view);
    if (view.camera.kind == scene::Camera::Kind::perspective && light_on_camera(*scene_, view.camera.position))
      throw Error(fmt::format("{}: {}", scene_->name, no_finite_answer));
    scene::Rendering out;
    out.film = scene::Film(view.width, view.height);
    scene::Film& film = out.film;
    const scene::PictureLayers layers(film, {airlight_kept(), surface_kept(), ambient_kept()});
    if (airlight_kept()) film.add("error");
    scene::Stopwatch watch;
    const scene::CameraRays rays(view.camera, view.width, view.height);
    const auto counts = scene::parallel_sum<Counts>(view.height, execution, [&](int y, Counts& of_row) {
      for (int x = 0; x < view.width; ++x) {
        Airlight airlight;
        layers.put(x, y, pixel(rays(x + 0.5, y + 0.5), airlight, of_row));
        if (airlight_kept()) film.set("error", x, y, airlight.error);
      }
    });
    out.times.push_back({"render", watch.lap()});
    out.counters = {{"rays", double(counts.rays)},
                    {"evaluations", double(counts.evaluations)},
                    {"pixels over tolerance", double(counts.unmet)},
                    {"infinite pixels", double(counts.infinite)}};
    film.metadata["method"] = "deterministic";
    film.metadata["scene"] = scene_->name;
    film.metadata["scene_hash"] = scene_->hash;
    film.metadata["settings"] = settings_;
    film.metadata["pixels_over_tolerance"] = std::to_string(counts.unmet);
    film.metadata["infinite_pixels"] = std::to_string(counts.infinite);
    if (any(*scene_, false)) film.metadata["left_out"] = "environment as a light of media and surfaces";
    return out;
  }

 private:
  bool airlight_kept() const { return any(*scene_, true) && any_scattering(*scene_); }
  bool surface_kept() const { return scene_->geometry || any(*scene_, false) || !scene_->backdrops.empty(); }
  bool ambient_kept() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && !scene_->media.empty(); }

  scene::Pixel pixel(const Ray& ray, Airlight& airlight, Counts& counts) const {
    scene::Pixel pixel;
    const scene::RayEnd end = scene::camera_end(*scene_, ray);
    const Rgb depth = integrator_.optical_depth(ray, end.t);
    pixel.transmittance = (-depth).exp();
    ++counts.rays;
    if (airlight_kept()) {
      airlight = integrator_(ray, end.t);
      counts.evaluations += airlight.evaluations;
      if (!airlight.radiance.allFinite())
        ++counts.infinite;
      else if (!airlight.converged)
        ++counts.unmet;
      pixel.airlight = airlight.radiance;
    }
    if (surface_kept() && pixel.transmittance.maxCoeff() > 0)
      pixel.surface =
          pixel.transmittance *
          scene::end_radiance(*scene_, ray, end, scene_->lights, [&](const scene::Incident&, std::size_t l) -> Rgb {
            return (-integrator_.light_depth(end.hit->position, int(l))).exp();
          });
    // 1 - exp(-depth) without cancelling: thin fog has a depth of 1e-8.
    if (ambient_kept())
      pixel.ambient = scene_->ambient_in_scatter * depth.unaryExpr([](double d) { return -std::expm1(-d); });
    return pixel;
  }

  std::shared_ptr<const Scene> scene_;
  std::string settings_;
  AirlightIntegrator integrator_;
};

class DeterministicRenderer final : public scene::Renderer {
 public:
  std::string name() const override { return "deterministic"; }
  std::string about() const override {
    return "noise-free single scattering by adaptive Gauss-Kronrod quadrature (reference)";
  }
  std::vector<SettingSpec> settings() const override { return scene::list_settings(bind); }
  std::vector<std::string> supports(const Scene& scene, const scene::Settings&) const override {
    if (scene.camera.kind == scene::Camera::Kind::perspective && light_on_camera(scene, scene.camera.position))
      return {no_finite_answer};
    if (const std::string reason = scene::too_thick(scene, 0.01); !reason.empty()) return {reason};
    if (const std::string reason = unsupported(scene); !reason.empty()) return {reason};
    return {};
  }

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const Scene> scene,
                                                     const scene::Settings& settings,
                                                     const scene::Execution&) const override {
    return std::make_unique<DeterministicPrepared>(std::move(scene), settings);
  }
};

}  // namespace

bool light_on_camera(const Scene& scene, const Point3& origin) {
  double density = 0;
  for (const scene::Medium& m : scene.media)
    if ((m.sigma_t * m.albedo).maxCoeff() > 0) density += scene::density(m, origin);
  if (!(density > 0)) return false;
  for (const scene::Light& light : scene.lights)
    if (const auto ball = scene::ball(light); ball && ball->center == origin) return true;
  return false;
}

std::unique_ptr<scene::Renderer> make_renderer() { return std::make_unique<DeterministicRenderer>(); }

}  // namespace airlight::deterministic
