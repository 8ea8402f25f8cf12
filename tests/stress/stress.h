// The stress list, cases at the ends of what scenes may hold: what they have in common.
//
// Statistical comparisons: all of [stress] together raise a false alarm with probability 1e-3 at most (seeds are
// fixed; `limit` is the two-sided normal threshold for `comparisons` of them), and each asserts how small a deviation
// it would have seen.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/renderers.h"
#include "reference/deterministic/airlight.h"
#include "scene/base/error.h"
#include "tests/pictures.h"
#include "tests/reference/path_tracer/scenes.h"

namespace airlight::stress {

using path_tracer::Estimate;
using path_tracer::Options;
using path_tracer::radiance;
using path_tracer::World;
using path_tracer::test::medium;
using path_tracer::test::ray_of;
using path_tracer::test::scene_of;
using path_tracer::test::white;
using test::all_finite;

inline constexpr int comparisons = 200;
inline const double limit = path_tracer::test::threshold(1e-3, comparisons);

// A standard deviation below 2^-26 = 1.5e-8 of the mean is lost where the squares of sums in double are subtracted, so
// that much is allowed besides the standard error. `resolution`: the standard error must be below this share of the
// expected value, or the comparison shows nothing.
inline void check_equal(double expected, double mean, double error, double resolution) {
  CAPTURE(expected, mean, error);
  CHECK(std::isfinite(mean));
  CHECK(std::abs(mean - expected) <= limit * error + 1.5e-8 * std::abs(expected));
  CHECK(error < resolution * std::abs(expected));
}
inline void check_equal(double expected, const Estimate& e, double resolution) {
  check_equal(expected, e.mean[0], e.error[0], resolution);
}

using Given = std::map<std::string, std::string>;

// Renderers that take every medium and every light, and today's fog of engines beside the references.
inline constexpr const char* renderers[] = {"path_tracer", "deterministic", "ray_marcher", "froxel_fog",
                                            "half_resolution_march"};
inline constexpr const char* biased_renderers[] = {"deterministic", "ray_marcher", "froxel_fog",
                                                   "half_resolution_march"};

// Films here have a few pixels: a froxel is one of them, and every pixel is marched.
inline Given of_small_films(const std::string& name, Given given = {}) {
  if (name == "froxel_fog") given.insert({{"tile", "1"}, {"slices", "128"}});
  if (name == "half_resolution_march") given.insert({{"divide", "1"}, {"jitter", "none"}, {"steps", "128"}});
  return given;
}
inline scene::Settings settings_of(const scene::Renderer& renderer, const Given& given) {
  return {renderer.settings(), of_small_films(renderer.name(), given)};
}

inline std::vector<std::string> refusals(const std::string& name, const scene::Scene& scene, const Given& given = {}) {
  const scene::Renderer& renderer = experiments::find_renderer(name, "stress");
  return renderer.supports(scene, settings_of(renderer, given));
}

inline scene::Film picture(const std::string& name, std::shared_ptr<const scene::Scene> scene, const scene::View& view,
                           const Given& given = {}) {
  const scene::Renderer& renderer = experiments::find_renderer(name, "stress");
  return renderer.prepare(std::move(scene), settings_of(renderer, given), {})->render(view, {}).film;
}

// A small picture from `position` towards `target`.
inline scene::View view_from(const Point3& position, const Point3& target, int side = 5, double fov = 0.5) {
  scene::View view;
  view.camera = scene::look_at(position, target, Vec3::UnitY());
  view.camera.vertical_fov = fov;
  view.width = view.height = side;
  return view;
}

inline scene::Medium of_field(scene::DensityField field, double sigma_t, double albedo,
                              const scene::Region& region = scene::Unbounded{}) {
  scene::Medium m = medium(region, sigma_t, albedo);
  m.field = std::move(field);
  return m;
}

inline scene::Medium of_grid(scene::VoxelGrid grid, double sigma_t, double albedo) {
  return of_field(std::make_shared<const scene::VoxelGrid>(std::move(grid)), sigma_t, albedo);
}

// A uniform direction from two uniforms.
inline Vec3 uniform_direction(double u1, double u2) {
  const double z = 2 * u1 - 1, r = std::sqrt(1 - z * z);
  return {r * std::cos(2 * pi * u2), r * std::sin(2 * pi * u2), z};
}

}  // namespace airlight::stress
