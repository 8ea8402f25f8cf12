// Pictures of variant `ray` against the deterministic reference and, as statistical tests, the path tracer: scenes that share nothing.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "experiments/judging/equality.h"
#include "methods/legendre_fluids/light.h"
#include "reference/deterministic/renderer.h"
#include "reference/path_tracer/renderer.h"
#include "scene/media/legendre_box.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace light_pictures_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::legendre_fluids::testing;

namespace {

const legendre_fluids::LegendreLight method;

scene::DirectionalLight sun(const Vec3& to_light, const Rgb& irradiance) { return {to_light.normalized(), irradiance}; }

scene::Surface wall(const Point3& at, const Vec3& normal, const Rgb& albedo) {
  return {"wall", scene::Plane{at, normal}, scene::Lambert{albedo}};
}

struct Case {
  const char* name;
  std::function<void(scene::Scene&)>
      change;           // of one medium of 4^3 coefficients in the unit box, seen by an orthographic camera
  double most;          // relative L2 error against the quadrature
  const char* samples;  // of the path tracer
};

const Case cases[] = {
    {"coloured, forward",
     [](scene::Scene& s) {
       s.media[0].sigma_t = {0.3, 1, 3};
       s.media[0].albedo = {0.9, 0.5, 0.7};
       s.media[0].phase = scene::HenyeyGreenstein{0.6};
       s.lights = {sun(oblique_light, {3, 2, 1})};
     },
     5e-8, "256"},
    {"perspective, from within, backward",
     [](scene::Scene& s) {
       s.camera = scene::look_at({0.5, -0.3, 0.2}, {-1, 0.4, -0.3}, Vec3::UnitY());
       s.camera.vertical_fov = 1.6;
       s.media[0].sigma_t = {2, 2, 2};
       s.media[0].phase = scene::HenyeyGreenstein{-0.4};
     },
     5e-8, "256"},
    {"two media in each other, two suns",
     [](scene::Scene& s) {
       s.media.push_back(smoke(random_density({3, 5, 2}, 8, 1, {{-0.4, -2, -0.7}, {1.6, 0.5, 0.9}}), 1));
       s.media[0].albedo = {0.9, 0.2, 0.4};
       s.media[0].phase = scene::Rayleigh{};
       s.media[1].sigma_t = {2, 1, 0.5};
       s.lights = {sun({0.2, 1, 0.1}, {1, 1, 1}), sun({-1, 0.3, 0.8}, {1, 2, 4})};
     },
     5e-8, "512"},
    {"one medium in the shadow of another",
     [](scene::Scene& s) {
       s.media.push_back(smoke(random_density({4, 4, 4}, 9, 1, {{-1.2, 1.3, -0.3}, {0.2, 2.4, 0.8}}), 4, 0.3));
       s.lights = {sun({-0.2, 1, 0.1}, {2, 2, 2})};
       s.camera.height = 5;
     },
     5e-8, "1280"},
    {"negative in places",
     [](scene::Scene& s) {
       Eigen::VectorXd c = std::get<scene::LegendrePointer>(s.media[0].field)->coefficients();
       c.tail(63) *= 2.5;
       s.media[0].field = std::make_shared<const scene::LegendreBox>(unit_box, scene::TensorShape{4, 4, 4}, c);
     },
     2e-7, "256"},
    {"a shadowgram on a wall, two suns",
     [](scene::Scene& s) {
       s.camera = scene::look_at({1, 2, 7}, {0, 0, -1}, Vec3::UnitY());
       s.camera.vertical_fov = 0.7;
       s.media[0].sigma_t = {0.5, 1, 2};
       s.lights = {sun({0.5, 0.3, 1}, {2, 2, 2}), sun({-0.6, 0.1, 1}, {1, 0.5, 0.2})};
       s.surfaces = {wall({0, 0, -1.8}, Vec3::UnitZ(), {0.8, 0.7, 0.6})};
     },
     5e-8, "512"},
    {"a ball in the smoke, its shadow, a floor",
     [](scene::Scene& s) {
       s.camera = scene::look_at({3, 2, 5}, {0, -0.2, 0}, Vec3::UnitY());
       s.camera.vertical_fov = 0.6;
       s.lights = {sun({0.5, 1, 0.3}, {2, 3, 4})};
       s.surfaces = {wall({0, -1, 0}, Vec3::UnitY(), {0.5, 0.5, 0.5}),
                     {"ball", scene::Sphere{{0.1, 0.2, 0.1}, 0.4}, scene::Phong{Rgb(.3, .4, .5), Rgb(.3, .3, .3), 10}}};
     },
     3e-7, "512"},
    {"flat, beside an even box, against the light",
     [](scene::Scene& s) {
       s.media = {smoke(random_density({6, 2, 5}, 4, 1, {{-1, -0.2, -1}, {1, 0.1, 1}}), 4, 0.95),
                  smoke(nullptr, 0.5, 0.6)};
       s.media[0].phase = scene::HenyeyGreenstein{-0.2};
       s.media[1].field = scene::Homogeneous{2};
       s.media[1].region = Box{{-0.8, 0.1, -0.5}, {0.9, 0.7, 0.6}};
       s.lights = {sun(oblique_view, {2, 2, 2})};
     },
     5e-8, "1536"},
};

std::shared_ptr<scene::Scene> scene_of(const Case& c, int width, int height) {
  auto scene = lit_scene(smoke(random_density({4, 4, 4}, 3), 1.5), oblique_light, oblique_view, width, height, 3);
  c.change(*scene);
  finish(*scene);
  return scene;
}

}  // namespace

TEST_CASE("legendre light: pictures equal the quadrature's", "[legendre_fluids][light]") {
  for (const Case& c : cases) {
    const auto scene = scene_of(c, 24, 18);
    CAPTURE(c.name);
    const scene::Film film = picture(method, scene, {}, 0);
    const scene::Film truth = picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-8"}}, 0);
    for (const char* layer : {"airlight", "transmittance", "mean"}) CHECK(relative_l2(film, truth, layer) <= c.most);
    if (scene->geometry) CHECK(relative_l2(film, truth, "surface") <= c.most);
  }
}

namespace {

// False alarms: 1e-3 for all scenes together.
void equal_the_path_tracer(const std::vector<Case>& scenes) {
  const double alpha = 1e-3 / double(std::size(cases));
  for (const Case& c : scenes) {
    const auto scene = scene_of(c, 24, 18);
    CAPTURE(c.name);
    // The path tracer lets light go from surface to surface: black ones.
    auto black = std::make_shared<scene::Scene>(*scene);
    for (scene::Surface& surface : black->surfaces) surface.material = scene::Lambert{Rgb::Zero()};
    finish(*black);
    scene::Film alone = picture(method, black, {}, 0);
    const scene::Film traced =
        picture(path_tracer::PathTracer(), black, {{"samples", c.samples}, {"max_order", "1"}}, 0);
    const experiments::Equality e = experiments::compare_equal(alone, traced, "mean", {}, alpha);
    if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("{}: {}\n", c.name, experiments::text(e));
    CHECK(e.equal);
    CHECK(e.detectable_bias < 0.03);
    // Twice the bias that it must be able to detect: it does.
    for (float& v : alone.layers["mean"]) v *= 0.94f;
    CHECK_FALSE(experiments::compare_equal(alone, traced, "mean", {}, alpha).equal);
  }
}

}  // namespace

// Colours and a phase function; several media and suns; surfaces and a shadow.
TEST_CASE("legendre light: pictures equal the path tracer's", "[legendre_fluids][light]") {
  equal_the_path_tracer({cases[0], cases[2], cases[6]});
}

TEST_CASE("legendre light: pictures of five more scenes equal the path tracer's",
          "[legendre_fluids][light][thorough]") {
  equal_the_path_tracer({cases[1], cases[3], cases[4], cases[5], cases[7]});
}

TEST_CASE("legendre light: what an environment scatters equals the path tracer's", "[legendre_fluids][light]") {
  auto scene = lit_scene(smoke(random_density({4, 4, 4}, 3), 1.5), oblique_light, oblique_view, 16, 12, 3);
  scene->media[0].sigma_t = {0.5, 1.5, 4};
  scene->media[0].albedo = {0.9, 0.5, 0.7};
  scene->media[0].phase = scene::HenyeyGreenstein{0.5};
  const scene::EnvironmentLight skies[] = {
      scene::make_constant_environment({1, 2, 0.5}),
      scene::make_sh_environment({Rgb(2, 1.5, 1), Rgb(0.8, -0.3, 0.1), Rgb(0.2, 0.4, -0.2), Rgb(-0.3, 0, 0.3)},
                                 Mat3::Identity(), Rgb::Ones())};
  for (const scene::EnvironmentLight& sky : skies)
    for (const bool with_sun : {false, true}) {
      if (!with_sun) scene->lights = {sky};
      if (with_sun) scene->lights = {sun(oblique_light, {3, 2, 1}), sky};
      finish(*scene);
      const scene::Film fine = picture(method, scene, {{"environment_directions", "2048"}}, 0);
      const scene::Film traced =
          picture(path_tracer::PathTracer(), scene, {{"samples", "2304"}, {"max_order", "1"}}, 0);
      const experiments::Equality e = experiments::compare_equal(fine, traced, "mean", {}, 2.5e-4);
      CHECK(e.equal);
      CHECK(e.detectable_bias < 0.01);
      // 256 directions; of an uneven sky they follow the luminance, and its colours less closely.
      CHECK(relative_l2(picture(method, scene, {}, 0), fine) <= (sky.sh.empty() ? 1e-3 : 0.03));
    }
}

TEST_CASE("legendre light: thin smoke under an even sky sends back its scattering times the length",
          "[legendre_fluids][light]") {
  auto scene = lit_scene(smoke(random_density({1, 1, 1}, 1), 1e-5, 0.75), {0, 1, 0}, {0, 0, -1}, 8, 6, 1);
  scene->lights = {scene::make_constant_environment({2, 4, 8})};
  finish(*scene);
  const scene::Film film = picture(method, scene, {}, 0);
  for (std::size_t i = 0; i < film.layer("airlight").size(); ++i)
    CHECK(film.layer("airlight")[i] == Approx(double(2 << i % 3) * 0.75 * 1e-5 * 2).epsilon(1e-4));
  const auto stage = [&](const char* name) {
    for (const scene::Stage& s : method.prepare(scene, scene::Settings(method.settings(), {}), {})->stages())
      if (s.name == name) return s;
    return scene::Stage{};
  };
  CHECK(stage("environment as a light").kept);
  CHECK(stage("airlight").kept);
  scene->media[0].albedo = Rgb::Zero();
  finish(*scene);
  CHECK_FALSE(stage("environment as a light").kept);
  CHECK_FALSE(stage("airlight").kept);
}

TEST_CASE("legendre light: threads change nothing; layers add up", "[legendre_fluids][light]") {
  auto scene = scene_of(cases[6], 24, 18);
  scene->ambient_in_scatter = {0.1, 0.2, 0.3};
  finish(*scene);
  const scene::Film film = picture(method, scene, {}, 1);
  CHECK(picture(method, scene, {}, 3).layers == film.layers);
  for (std::size_t i = 0; i < film.layer("mean").size(); ++i)
    CHECK(film.layer("mean")[i] ==
          Approx(film.layer("airlight")[i] + film.layer("surface")[i] + film.layer("ambient")[i]));
  const scene::Film truth = picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-7"}}, 0);
  CHECK(relative_l2(film, truth, "ambient") <= 1e-6);
}

}  // namespace light_pictures_test
