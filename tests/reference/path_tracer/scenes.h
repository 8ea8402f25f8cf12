// Small scenes and oracle vectors for the tests of the path tracer.
#pragma once
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "reference/path_tracer/single_rays.h"
#include "scene/environment.h"

namespace airlight::path_tracer::test {

// By reference, so that a loop over a part of it is a loop over something that lives.
inline const nlohmann::json& vector_of(const std::string& id) {
  std::ifstream in(std::string(AIRLIGHT_SOURCE_DIR) + "/tests/vectors/references.json");
  static const nlohmann::json file = nlohmann::json::parse(in);
  for (const auto& v : file.at("vectors"))
    if (v.at("id") == id) return v;
  throw std::runtime_error("no vector " + id);
}

inline Vec3 vec(const nlohmann::json& j) { return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()}; }

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
