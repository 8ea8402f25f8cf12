// Light in Legendre boxes on the device against the CPU: every layer, at the 99th percentile and at the worst pixel.
#include "methods/legendre_fluids/light.h"

#include <fmt/ranges.h>

#include <catch2/catch.hpp>

#include "gpu/legendre_fluids/light.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace light_test {

using namespace airlight;
using namespace legendre_fluids::testing;
using Catch::Contains;

namespace {

constexpr double bound = 3e-6;   // three times what is measured
constexpr double bent = 3.5e-6;  // three times what is measured, where light has kinks
constexpr double edges =
    3e-5;  // edges of shadows are known to 1/4096 of the way between two shadow rays, on either side

using ScenePointer = std::shared_ptr<scene::Scene>;

void compare(const char* name, const ScenePointer& scene, double most, const test::Given& given = {}) {
  const scene::Film a = test::render(legendre_fluids::LegendreLight(), scene, given).film;
  const scene::Rendering on_device = test::render(gpu::legendre_fluids::LegendreLight(), scene, given);
  const scene::Film& b = on_device.film;
  most += 20 * gpu::test::injected_error();
  gpu::test::agree(fmt::format("{} {}", name, fmt::join(given, " ")), a, b, {most, most});
  if (on_device.counters.count("rounds")) {
    CHECK(on_device.counters.at("rounds") < 200);
    CHECK(on_device.counters.at("stretches_at_limit") == 0);
  }
}

ScenePointer oblique(const scene::TensorShape& n, double depth, unsigned seed = 3) {
  return lit_scene(smoke(random_density(n, seed), 0.5 * depth), oblique_light, oblique_view, 14, 11);
}

}  // namespace

DEVICE_TEST_CASE("legendre light on the device: optical depths from thin to black",
                 "[gpu][legendre_fluids][thorough]") {
  for (const double depth : {1e-3, 0.1, 1.0, 5.0, 20.0, 100.0, 5e3}) {
    CAPTURE(depth);
    // Depths are rounded to 6e-8 of the whole one.
    compare("depth", oblique({4, 4, 4}, depth), bound + 2.5e-7 * depth);
  }
  compare("6", oblique({6, 6, 6}, 2), bound);
  compare("points", oblique({6, 6, 6}, 20), 3 * bound, {{"points", "4"}});
  compare("points", oblique({6, 6, 6}, 20), 3 * bound, {{"points", "12"}, {"tolerance", "1e-10"}});
  compare("unequal", oblique({5, 3, 7}, 2), bound);
  compare("one", oblique({1, 1, 1}, 2), bound);
}

DEVICE_TEST_CASE("legendre light on the device: colours, several media and lights, cameras, phase functions",
                 "[gpu][legendre_fluids]") {
  ScenePointer scene = oblique({4, 5, 3}, 2);
  scene->media[0].sigma_t = Rgb(0.5, 1, 2);
  scene->media[0].albedo = Rgb(0.9, 0.7, 0.5);
  scene->media[0].phase = scene::HenyeyGreenstein{0.6};
  scene->ambient_in_scatter = Rgb(0.1, 0.2, 0.3);
  compare("colours", scene, bound);
  scene->media[0].sigma_t = Rgb(0.5, 1, 40);  // panels follow the channel that needs most
  compare("unlike colours", scene, 2e-5);
  scene->media[0].sigma_t = Rgb(0.5, 1, 2);
  scene->lights.push_back(scene::DirectionalLight{Vec3(0, 1, 0), Rgb(1, 2, 3)});
  scene->lights.push_back(scene::DirectionalLight{Vec3(1, 1e-6, 0).normalized(), Rgb(3, 2, 1)});
  compare("lights", scene, bound);
  scene->camera = scene::look_at(Point3(0.3, 0.2, 3), Point3::Zero(), Vec3::UnitY());
  compare("perspective", scene, bound);
  scene->camera = scene::look_at(Point3(0.3, 0.2, -0.4), Point3(2, 0, 0), Vec3::UnitY());
  compare("within", scene, bound);
  scene::Medium other = smoke(random_density({3, 3, 3}, 5, 1, {Point3(0.2, -1.5, -0.5), Point3(2, 0.5, 1)}), 1.5);
  other.phase = scene::Rayleigh{};
  scene->media.push_back(other);
  scene->camera = scene::look_at(Point3(0.3, 0.2, 5), Point3::Zero(), Vec3::UnitY());
  compare("two media", scene, bound);
  scene::Medium haze;
  haze.region = Box{Point3(-3, -1, -3), Point3(3, 0, 3)};
  haze.sigma_t = Rgb::Constant(0.05);
  haze.phase = scene::Hazy{};
  scene->media.push_back(haze);
  compare("three media", scene, bound);
}

DEVICE_TEST_CASE("legendre light on the device: an environment lights the smoke and a wall behind it",
                 "[gpu][legendre_fluids][thorough]") {
  ScenePointer scene = oblique({4, 5, 3}, 2);
  scene->media[0].sigma_t = Rgb(0.5, 1, 2);
  scene->lights = {scene::make_constant_environment({1, 2, 0.5})};
  compare("even sky", scene, bound);
  // Below 0 in places.
  scene->lights = {scene::make_sh_environment({Rgb(2, 1.5, 1), Rgb(1.9, -0.3, 2), Rgb(0.2, 1.4, -2), Rgb(-0.3, 0, 0.3)},
                                              Mat3::Identity(), Rgb::Ones())};
  compare("uneven sky", scene, 4 * bound, {{"environment_directions", "24"}});
}

DEVICE_TEST_CASE("legendre light on the device: scenes without light, without media", "[gpu][legendre_fluids]") {
  ScenePointer scene = oblique({4, 4, 4}, 2);
  scene->lights.clear();
  compare("dark", scene, bound);
  scene->media.clear();
  compare("empty", scene, bound);
}

DEVICE_TEST_CASE("legendre light on the device: surfaces behind and within the medium", "[gpu][legendre_fluids]") {
  ScenePointer scene = oblique({4, 4, 4}, 2);
  scene->lights = {scene::DirectionalLight{Vec3(0.2, 0.3, 1).normalized(), Rgb(1, 2, 3)}};
  scene->camera = scene::look_at(Point3(0.3, 0.2, 5), Point3::Zero(), Vec3::UnitY());
  scene::Surface wall;
  wall.shape = scene::Plane{Point3(0, 0, -1.5), Vec3::UnitZ()};
  scene->surfaces = {wall};
  finish(*scene);
  compare("wall", scene, bound);
}

// Surfaces between light and medium, in the medium, and around the camera; several lights, of which some are shaded; many edges on a ray.
DEVICE_TEST_CASE("legendre light on the device: shadows of surfaces in the medium",
                 "[gpu][legendre_fluids][thorough]") {
  const auto add = [](scene::Scene& scene, const auto& shape) {
    scene::Surface surface;
    surface.shape = shape;
    scene.surfaces.push_back(surface);
    finish(scene);
  };
  ScenePointer scene = oblique({4, 4, 4}, 2);
  scene->camera = scene::look_at(Point3(0.3, 0.2, 5), Point3::Zero(), Vec3::UnitY());
  add(*scene, scene::Sphere{Point3(-0.3, -0.4, 0.5), 0.35});
  compare("a ball", scene, bound);
  compare("a ball, few shadow rays", scene, bound, {{"shadow_steps", "7"}});
  add(*scene, scene::Plane{Point3(0.3, 0, 0), Vec3(1, 0.1, -0.2).normalized()});
  compare("a ball, a wall through the smoke", scene, bound);
  // A fence: nine slats.
  scene::TriangleMesh fence;
  for (int slat = 0; slat < 9; ++slat) {
    const double x = -2.2 + 0.4 * slat;
    const int first = int(fence.vertices.size());
    for (const Point3& v : {Point3(x, -2, 1.4), Point3(x + 0.2, -2, 1.4), Point3(x + 0.2, 2, 1.4), Point3(x, 2, 1.4)})
      fence.vertices.push_back(v);
    fence.triangles.push_back({first, first + 1, first + 2});
    fence.triangles.push_back({first, first + 2, first + 3});
  }
  add(*scene, fence);
  scene->camera = scene::look_at(Point3(-4, 0.2, 1.1), Point3(0, 0, 0.2), Vec3::UnitY());
  compare("a fence", scene, edges);
  scene->lights.push_back(scene::DirectionalLight{Vec3(0, 1, 0), Rgb(1, 2, 3)});
  scene->lights.push_back(scene::DirectionalLight{Vec3(-1, 0.1, 0.2).normalized(), Rgb(3, 2, 1)});
  scene->media[0].sigma_t = Rgb(0.5, 1, 2);
  compare("a fence, three lights", scene, edges);
  Eigen::VectorXd c = random_density({4, 4, 4}, 3)->coefficients();
  c[0] *= 0.3;
  scene->media[0].field = std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{4, 4, 4}, c);
  compare("a fence, density below 0", scene, edges);
  scene->media.push_back(smoke(random_density({3, 3, 3}, 5, 1, {Point3(0.2, -1.5, -0.5), Point3(2, 0.5, 1)}), 1.5));
  finish(*scene);
  compare("a fence, two media", scene, edges);
}

// Densities below 0 are taken as 0, on rays and on the way of the light.
DEVICE_TEST_CASE("legendre light on the device: densities that are below 0 in places",
                 "[gpu][legendre_fluids][thorough]") {
  const auto rough = [](const scene::TensorShape& n, unsigned seed, double mean, const Box& box = unit_box) {
    Eigen::VectorXd c = random_density(n, seed, 1, box)->coefficients();
    c[0] *= mean;
    return std::make_shared<const scene::LegendreBox>(box, n, c);
  };
  ScenePointer scene = oblique({4, 4, 4}, 2);
  for (const double mean : {0.5, 0.0}) {
    scene->media[0].field = rough({4, 4, 4}, 3, mean);
    REQUIRE(scene->media[0].sigma_t[0] == 1);
    compare("negative", scene, bent);
  }
  scene->media[0].field = rough({6, 6, 6}, 5, 0.2);
  compare("negative 6", scene, bent);
  Eigen::VectorXd wave = Eigen::VectorXd::Zero(8);
  wave[0] = 1, wave[7] = 2;
  scene->media[0].field = std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{2, 2, 2}, wave);
  compare("wave", scene, bent);
  wave.setZero();
  wave[0] = -1;
  scene->media[0].field = std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{2, 2, 2}, wave);
  compare("nowhere above", scene, bent);
  scene->media[0].field = rough({4, 4, 4}, 3, 0.2);
  scene->lights = {scene::DirectionalLight{Vec3(0, 1, 0), Rgb(1, 2, 3)},
                   scene::DirectionalLight{Vec3(0.5, 0.6, 0.3).normalized(), Rgb(3, 2, 1)}};
  compare("lights", scene, bent);
  scene->media[0].sigma_t = Rgb(0.5, 1, 20);
  compare("colours", scene, 2.7e-5);  // depths up to 40
  scene->media.push_back(smoke(rough({3, 3, 3}, 5, 0.5, {Point3(0.2, -1.5, -0.5), Point3(2, 0.5, 1)}), 1.5));
  compare("two media", scene, bent);
  scene->camera = scene::look_at(Point3(0.3, 0.2, 5), Point3::Zero(), Vec3::UnitY());
  scene::Surface wall;
  wall.shape = scene::Plane{Point3(0, -3, 0), Vec3::UnitY()};
  scene->surfaces = {wall};
  finish(*scene);
  compare("two media, a floor", scene, bent);
  scene->lights.clear();
  compare("dark", scene, bent);
  for (const double depth : {1e-3, 0.1, 20.0, 100.0}) {
    CAPTURE(depth);
    scene = oblique({4, 4, 4}, depth);
    scene->media[0].field = rough({5, 4, 6}, 7, 0.1);
    compare("negative depth", scene, bent);
  }
}

TEST_CASE("legendre light on the device: what shaders do not know is refused by name", "[gpu][legendre_fluids]") {
  const gpu::legendre_fluids::LegendreLight method;
  const auto objections = [&](const scene::Scene& scene) {
    return method.supports(scene, scene::Settings(method.settings(), {}));
  };
  ScenePointer scene = oblique({4, 4, 4}, 2);
  CHECK(objections(*scene).empty());
  scene->media[0].field = random_density({20, 20, 20}, 1);
  CHECK_THAT(objections(*scene).at(0), Contains("8000"));
}

}  // namespace light_test
