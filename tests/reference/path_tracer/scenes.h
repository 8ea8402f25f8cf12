// Small scenes for the tests of the path tracer.
#pragma once
#include <cmath>
#include <memory>
#include <string>

#include "reference/path_tracer/single_rays.h"
#include "scene/light/environment.h"

namespace airlight::path_tracer::test {

inline scene::PhaseFunction phase_of(const std::string& name, double g = 0) {
  if (name == "rayleigh" || name == "ray") return scene::Rayleigh{};
  if (name == "hg") return scene::HenyeyGreenstein{g};
  if (name == "hazy") return scene::Hazy{};
  if (name == "murky") return scene::Murky{};
  return scene::Isotropic{};
}

inline scene::Medium medium(const scene::Region& region, double sigma_t, double albedo,
                            const scene::PhaseFunction& phase = scene::Isotropic{}) {
  scene::Medium m;
  m.region = region;
  m.sigma_t = Rgb::Constant(sigma_t);
  m.albedo = Rgb::Constant(albedo);
  m.phase = phase;
  return m;
}

inline std::shared_ptr<scene::Scene> scene_of(std::vector<scene::Medium> media, std::vector<scene::Light> lights,
                                              std::vector<scene::Surface> surfaces = {}) {
  auto s = std::make_shared<scene::Scene>();
  s->media = std::move(media);
  s->lights = std::move(lights);
  s->surfaces = std::move(surfaces);
  if (!s->surfaces.empty()) s->geometry = std::make_shared<scene::Geometry>(s->surfaces);
  return s;
}

inline Ray ray_of(const Point3& o, const Vec3& d) { return {o, d.normalized()}; }

// Two-sided normal threshold for `tests` comparisons together at a false-alarm rate alpha: the solution of
// erfc(z / sqrt 2) = alpha / tests.
inline double threshold(double alpha, int tests) {
  double lo = 0, hi = 40;
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (lo + hi);
    (std::erfc(mid / std::sqrt(2.0)) > alpha / tests ? lo : hi) = mid;
  }
  return lo;
}

inline scene::EnvironmentLight white() { return scene::make_constant_environment(Rgb::Ones()); }

}  // namespace airlight::path_tracer::test
