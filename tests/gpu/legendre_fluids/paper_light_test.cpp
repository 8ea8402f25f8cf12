// Light by the paper's systems on the device against the CPU: every layer, at the worst pixel; what frames send and count.
#include <fmt/ranges.h>

#include <catch2/catch.hpp>

#include "gpu/legendre_fluids/light.h"
#include "methods/legendre_fluids/light.h"
#include "scene/flow/particles.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/device.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace paper_light_test {

using namespace airlight;
using namespace legendre_fluids::testing;
using Catch::Contains;
using test::Given;

namespace {

constexpr double bound = 1e-6;  // of the greatest value

using ScenePointer = std::shared_ptr<scene::Scene>;

Given paper(const std::string& closure, int n, Given more = {}) {
  more.insert({{"variant", "paper"}, {"closure", closure}, {"n", std::to_string(n)}});
  return more;
}

// The greatest difference of a layer over its greatest value.
double worst(const scene::Film& a, const scene::Film& b) {
  double error = 0;
  REQUIRE(a.layers.size() == b.layers.size());
  for (const auto& [layer, values] : a.layers) {
    double most = 1e-300, off = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      most = std::max(most, double(values[i]));
      const double difference = std::abs(double(values[i]) - b.layer(layer)[i]);
      off = std::max(off, difference == difference ? difference : infinity);
    }
    error = std::max(error, off / most);
  }
  return error;
}

void compare(const char* name, const ScenePointer& scene, const Given& given, double most = bound) {
  const scene::Rendering a = test::render(legendre_fluids::LegendreLight(), scene, given);
  const scene::Rendering b = test::render(gpu::legendre_fluids::LegendreLight(), scene, given);
  const double error = worst(a.film, b.film);
  CAPTURE(name, given, error);
  CHECK(error < most);
  for (const char* counter : {"rays", "unknowns"}) CHECK(a.counters.at(counter) == b.counters.at(counter));
  for (const char* share : {"negative_share", "negative_direct_share", "negative_density_share"})
    CHECK(b.counters.at(share) == Approx(a.counters.at(share)).margin(2e-3));
  if (std::getenv("AIRLIGHT_TEST_FIGURES"))
    fmt::print("{} {}: {:.1e} of {:.1e}, {} iterations ({}), {:.1f} ms of scattered systems ({:.1f})\n", name,
               fmt::join(given, " "), error, most, b.counters.at("iterations"), a.counters.at("iterations"),
               1e3 * b.times.at(0).seconds, 1e3 * a.times.at(0).seconds);
}

ScenePointer oblique(const scene::TensorShape& n, double depth, unsigned seed = 3) {
  return lit_scene(smoke(random_density(n, seed), 0.5 * depth), oblique_light, oblique_view, 14, 11);
}

}  // namespace

DEVICE_TEST_CASE("legendre light on the device: the paper's systems from thin to black",
                 "[gpu][legendre_fluids][thorough]") {
  for (const char* closure : {"upwind", "least_squares"})
    for (const double depth : {1e-6, 0.1, 1.0, 5.0, 20.0, 100.0}) {
      CAPTURE(depth);
      for (const int n : {4, 6}) compare("depth", oblique({4, 4, 4}, depth), paper(closure, n));
    }
}

DEVICE_TEST_CASE("legendre light on the device: the paper's systems with up to 16 coefficients",
                 "[gpu][legendre_fluids][thorough]") {
  compare("8", oblique({4, 4, 4}, 5), paper("upwind", 8));
  compare("8", oblique({6, 6, 6}, 5), paper("least_squares", 8));
  compare("unequal", oblique({5, 3, 7}, 2), paper("upwind", 7));
  compare("16", oblique({4, 4, 4}, 20), paper("upwind", 16));
  compare("12", oblique({4, 4, 4}, 20), paper("least_squares", 12, {{"boundary_weight", "10"}}));
}

DEVICE_TEST_CASE("legendre light on the device: the paper's systems by colours, lights, boxes, truncations",
                 "[gpu][legendre_fluids][thorough]") {
  const Box flat{{-1, 0, 2}, {3, 0.7, 3}};
  auto scene = lit_scene(smoke(random_density({4, 3, 2}, 5, 1, flat), 1), {1, 0, 0}, {0.2, -1, 0.1}, 24, 12, 4);
  scene->camera.position += flat.center();
  for (const char* closure : {"upwind", "least_squares"}) compare("flat", scene, paper(closure, 5));
  scene->media[0].sigma_t = {0.2, 0.4, 0.2};
  scene->media[0].albedo = {0.9, 0.5, 0.1};
  scene->media[0].phase = scene::HenyeyGreenstein{0.5};
  scene->lights = {scene::DirectionalLight{Vec3(0, 1, 0), {1, 2, 3}},
                   scene::DirectionalLight{Vec3(0.1, 1, 0.1).normalized(), {3, 1, 1}},
                   scene::DirectionalLight{Vec3(1, 1e-6, 0).normalized(), {0.5, 0, 0}}};
  finish(*scene);
  for (const char* closure : {"upwind", "least_squares"}) compare("colours", scene, paper(closure, 5));
  for (const char* weight : {"1e-6", "1e-3", "0.1", "100", "1000"})
    compare("weight", scene, paper("least_squares", 4, {{"boundary_weight", weight}}), 6 * bound);
  compare("chebyshev", scene, paper("least_squares", 6, {{"truncation", "chebyshev"}}));
  scene->camera.position = flat.center();  // within
  compare("within", scene, paper("upwind", 4));
  // Nothing moves along z.
  scene->media[0].field = random_density({4, 4, 1}, 3, 1, flat);
  scene->lights = {scene::DirectionalLight{Vec3(1, 0, 0), Rgb::Ones()}};
  scene->camera = scene::look_at(Point3(-2, -9, 2.5), Point3(1, 0.3, 2.5), Vec3::UnitZ());
  scene->camera.kind = scene::Camera::Kind::orthographic;
  scene->camera.height = 3;
  finish(*scene);
  for (const char* closure : {"upwind", "least_squares"}) compare("plane", scene, paper(closure, 8));
  for (const char* closure : {"upwind", "least_squares"}) compare("one", scene, paper(closure, 1));
}

DEVICE_TEST_CASE("legendre light on the device: the paper's systems with an albedo that is a field",
                 "[gpu][legendre_fluids]") {
  auto colours = with_albedo_field(oblique({4, 3, 5}, 2), {4, 3, 5}, 5);
  for (scene::Medium& medium : colours->media) medium.sigma_t = {0.4, 0.8, 0.4};
  colours->lights.push_back(scene::DirectionalLight{Vec3(0.1, 1, 0.1).normalized(), {3, 1, 1}});
  finish(*colours);
  for (const char* closure : {"upwind", "least_squares"}) compare("albedo", colours, paper(closure, 4));
}

// Depths in front of the box, in it, behind it, and none; flakes, drawn by the camera.
DEVICE_TEST_CASE("legendre light on the device: the paper's systems before pictures with depth",
                 "[gpu][legendre_fluids][thorough]") {
  const auto with_ends = [](ScenePointer scene, double step) {
    auto picture = std::make_shared<scene::Backdrop>();
    picture->width = scene->width;
    picture->height = scene->height;
    for (int i = 0; i < scene->width * scene->height; ++i) {
      picture->depth.push_back(i % 11 == 10 ? float(infinity) : float(3 + step * (i % 23)));
      for (const float c : {2.f, 3.f, 4.f}) picture->radiance.push_back(c);
    }
    scene::Particles flakes;
    flakes.radius = 0.04;
    flakes.radiances = {Rgb(5, 2, 1)};
    for (int i = 0; i < 100; ++i) flakes.positions.push_back(Point3(std::sin(i), std::sin(1.7 * i), std::sin(2.3 * i)));
    scene->backdrops = {
        picture, std::make_shared<scene::Backdrop>(scene::draw(flakes, scene->camera, scene->width, scene->height))};
    finish(*scene);
    return scene;
  };
  for (const char* closure : {"upwind", "least_squares"})
    for (const double depth : {0.1, 1.0, 5.0, 20.0})
      compare("ends", with_ends(oblique({4, 4, 4}, depth), 0.17), paper(closure, 6));
  ScenePointer scene = oblique({6, 3, 5}, 2);
  scene->media[0].sigma_t = {0.4, 1, 2};
  scene->lights.push_back(scene::DirectionalLight{Vec3(0.1, 1, 0.1).normalized(), {3, 1, 1}});
  scene->camera.position = Point3(0.3, 0.2, 0.1);  // within
  compare("colours, from within", with_ends(scene, 0.05), paper("upwind", 5));
  scene = lit_scene(smoke(random_density({8, 8, 8}, 3), 1), {0, 1, 0}, {0, 0, -1}, 24, 20);
  compare("along an axis", with_ends(scene, 0.17), paper("upwind", 6));
  // Layers that nobody asks for are not downloaded, and the picture does not change.
  const gpu::legendre_fluids::LegendreLight method;
  const auto prepared = method.prepare(scene, {method.settings(), paper("upwind", 6)}, {1, {}});
  scene::Execution some{1, {}};
  some.layers = std::set<std::string>{"mean"};
  const scene::Film mean = prepared->render(view_of(*scene), some).film;
  CHECK(mean.layers.size() == 1);
  CHECK(mean.layer("mean") == prepared->render(view_of(*scene), {1, {}}).film.layer("mean"));
  scene::View other = view_of(*scene);
  other.camera.height *= 2;
  CHECK_THROWS_WITH(prepared->render(other, {1, {}}), Contains("belongs to the scene's own camera"));
}

DEVICE_TEST_CASE("legendre light on the device: the paper's systems before surfaces and an environment",
                 "[gpu][legendre_fluids][thorough]") {
  ScenePointer scene = oblique({4, 4, 4}, 2);
  scene->camera = scene::look_at(Point3(0.3, 0.2, 5), Point3::Zero(), Vec3::UnitY());
  scene->camera.kind = scene::Camera::Kind::orthographic;
  scene->camera.height = 4;
  scene->lights = {scene::DirectionalLight{Vec3(0.2, 0.3, 1).normalized(), Rgb(1, 2, 3)}};
  scene::Surface wall;
  wall.shape = scene::Plane{Point3(0, 0, -3), Vec3::UnitZ()};
  wall.material = scene::Lambert{Rgb(0.8, 0.5, 0.3)};
  scene->surfaces = {wall};
  finish(*scene);
  for (const char* closure : {"upwind", "least_squares"}) compare("a shadowgram", scene, paper(closure, 6), 3 * bound);
  scene->media[0].sigma_t = {0.5, 1, 2};
  scene->lights.push_back(scene::DirectionalLight{Vec3(-0.3, 0.1, 1).normalized(), {3, 1, 1}});
  wall.shape = scene::Sphere{Point3(0.2, -0.1, -2.4), 0.3};
  scene->surfaces.push_back(wall);
  scene->backdrops = {std::make_shared<scene::Backdrop>(
      scene::draw(scene::Particles{{}, {Point3(0, 0, 0.3), Point3(0.4, 0.3, -0.5)}, 0.2, {Rgb::Ones()}}, scene->camera,
                  scene->width, scene->height))};
  finish(*scene);
  compare("colours, two suns, a wall, a ball, particles", scene, paper("upwind", 5), 3 * bound);
  const auto alike = [&](const ScenePointer& s) {
    const double error = worst(test::render(legendre_fluids::LegendreLight(), s, paper("upwind", 5)).film,
                               test::render(gpu::legendre_fluids::LegendreLight(), s, paper("upwind", 5)).film);
    CAPTURE(error);
    CHECK(error < 3 * bound);
  };
  scene->media[0].albedo = Rgb::Zero();
  alike(scene);
  auto dark = std::make_shared<scene::Scene>(*scene);
  dark->lights.clear();
  alike(dark);
  dark->surfaces.clear();
  dark->lights = {scene::make_constant_environment({1, 2, 0.5})};
  finish(*dark);
  alike(dark);
  scene->media.clear();
  finish(*scene);
  alike(scene);
}

DEVICE_TEST_CASE("legendre light on the device: the paper's systems where nothing is lit", "[gpu][legendre_fluids]") {
  ScenePointer scene = oblique({4, 4, 4}, 2);
  const auto black = [&] {
    const scene::Film film = test::render(gpu::legendre_fluids::LegendreLight(), scene, paper("upwind", 4)).film;
    return film.layers.size() == 2 && film.layer("mean") == std::vector<float>(film.layer("mean").size(), 0) &&
           film.layer("airlight") == film.layer("mean");
  };
  scene->media[0].field =
      std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{2, 2, 2}, Eigen::VectorXd::Zero(8));
  CHECK(black());
  scene->lights.clear();
  CHECK(black());
  scene->media.clear();
  CHECK(black());
}

DEVICE_TEST_CASE("legendre light on the device: another view of the paper's systems", "[gpu][legendre_fluids]") {
  const ScenePointer scene = oblique({4, 4, 4}, 2);
  const gpu::legendre_fluids::LegendreLight method;
  for (const char* closure : {"upwind", "least_squares"}) {
    const auto prepared = method.prepare(scene, {method.settings(), paper(closure, 6)}, {1, {}});
    const scene::View view = view_of(*scene);
    // Its tables go up, and the picture is that of a scene seen so.
    scene::View turned = view;
    turned.camera = scene::look_at(Point3(3, 4, 0.5), Point3::Zero(), Vec3::UnitY());
    turned.camera.kind = scene::Camera::Kind::orthographic;
    turned.camera.height = view.camera.height;
    const scene::Film seen = prepared->render(turned, {1, {}}).film;
    auto other = std::make_shared<scene::Scene>(*scene);
    other->camera = turned.camera;
    CHECK(worst(test::render(legendre_fluids::LegendreLight(), other, paper(closure, 6)).film, seen) < bound);
  }
}

TEST_CASE("legendre light on the device: what the paper's systems refuse there", "[gpu][legendre_fluids]") {
  const gpu::legendre_fluids::LegendreLight method;
  const auto objections = [&](const scene::Scene& scene, const Given& given) {
    return method.supports(scene, scene::Settings(method.settings(), given));
  };
  ScenePointer scene = oblique({4, 4, 4}, 2);
  for (const char* closure : {"upwind", "least_squares"}) CHECK(objections(*scene, paper(closure, 12)).empty());
  CHECK_THAT(objections(*scene, paper("upwind", 17)).at(0), Contains("n = 17"));
  CHECK_THAT(objections(*scene, paper("least_squares", 6, {{"boundary_weight", "2000"}})).at(0),
             Contains("boundary_weight = 2000"));
  scene->backdrops = {
      std::make_shared<scene::Backdrop>(scene::draw(scene::Particles{{}, {}, 1, {Rgb::Ones()}}, scene->camera, 4, 4))};
  CHECK(objections(*scene, paper("upwind", 6)).empty());
  scene->media[0].field = random_density({16, 16, 16}, 1);
  CHECK_THAT(objections(*scene, paper("upwind", 6)).at(0), Contains("a density of 4096 coefficients"));
  scene = oblique({4, 4, 4}, 2);
  scene->lights.push_back(scene::make_constant_environment(Rgb::Ones()));
  CHECK_THAT(objections(*scene, paper("upwind", 6)).at(0), Contains("an environment has all of them"));
  scene->camera.kind = scene::Camera::Kind::perspective;
  CHECK_THAT(objections(*scene, paper("upwind", 6)).at(0), Contains("orthographic"));
}

}  // namespace paper_light_test
