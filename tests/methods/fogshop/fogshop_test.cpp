#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/homogeneous_airlight.h"
#include "methods/fogshop/paper_airlight.h"
#include "reference/deterministic/renderer.h"
#include "scene/base/error.h"
#include "tests/methods/fogshop/small_scene.h"

namespace fogshop_test {

using namespace fogshop_scenes;
using airlight::test::relative_l2;
using scene::Film;

namespace {

std::vector<std::string> reasons(const Scene& scene, const Pairs& given = {}) {
  return method.supports(scene, settings(given));
}

}  // namespace

TEST_CASE("fogshop says what it cannot render", "[fogshop]") {
  Scene scene = small_scene();
  CHECK(reasons(scene).empty());
  scene.media = {gaussians({{Point3(0, 0, -4), 1, 0.5}}, 0.1), homogeneous(0.2)};
  CHECK(reasons(scene).empty());

  const auto refused = [&](auto&& change, const std::string& word, const Pairs& given = {}) {
    Scene changed = scene;
    change(changed);
    const auto why = reasons(changed, given);
    INFO(word);
    REQUIRE(why.size() == 1);
    CHECK(why[0].find(word) != std::string::npos);
    CHECK_THROWS_AS(method.prepare(std::make_shared<const Scene>(changed), settings(given), {}), Error);
  };
  refused([](Scene& s) { s.media[0].region = scene::Sphere{Point3::Zero(), 3}; }, "bounded");
  refused([](Scene& s) { s.media[0].phase = scene::Rayleigh{}; }, "rayleigh, expected isotropic or hg");
  const auto forward = [](Scene& s) { s.media[0].phase = scene::HenyeyGreenstein{0.5}; };
  refused(
      [&](Scene& s) {
        forward(s);
        s.media.pop_back();
      },
      "its closed form (Eq. 17) is of the isotropic one");
  refused(
      [&](Scene& s) {
        forward(s);
        std::get<scene::GaussianSum>(s.media[0].field).constant = 0;
      },
      "another phase function than the first");
  const auto alone = [&](Scene& s) {
    forward(s);
    s.media.pop_back();
    std::get<scene::GaussianSum>(s.media[0].field).constant = 0;
  };
  refused(
      [&](Scene& s) {
        alone(s);
        s.lights.push_back(scene::make_constant_environment(Rgb::Ones()));
      },
      "NPSF is that of isotropic scattering");
  refused(
      [](Scene& s) {
        s.media[1].albedo = Rgb::Constant(0.5);
        s.surfaces.push_back({"wall", scene::Plane{Point3(0, 0, -6), Vec3(0, 0, 1)}, scene::Lambert{}});
        finish(s);
      },
      "albedo", {{"reflectance", "npsf"}});
  refused([](Scene& s) { s.media[1].sigma_t = Rgb(1, 2, 3); }, "extinction_ratio");
  refused([](Scene& s) { std::get<scene::GaussianSum>(s.media[0].field).gaussians[0].amplitude = -1; }, "negative");
  refused([](Scene& s) { std::get<scene::GaussianSum>(s.media[0].field).cutoff = 3; }, "widths");
  refused([](Scene& s) { s.lights.push_back(scene::SpotLight{}); }, "spot");
  refused([](Scene& s) { s.lights.push_back(scene::DirectionalLight{}); }, "directional");
  refused([](Scene& s) { std::get<scene::PointLight>(s.lights[0]).position = s.camera.position; }, "infinite");
  refused([](Scene& s) { s.camera.kind = scene::Camera::Kind::orthographic; }, "perspective", {{"variant", "paper"}});
  refused([](Scene&) {}, "even", {{"K", "7"}});
  refused([](Scene&) {}, "GB", {{"map_directions", "2048"}, {"map_edges", "4096"}});
  // Each light has a map of its own.
  const Pairs large{{"map_directions", "1024"}, {"map_edges", "64"}};
  CHECK(reasons(scene, large).empty());
  refused([](Scene& s) { s.lights.resize(16, s.lights[0]); }, "16 light maps of 4.4 GB in all", large);
  refused([](Scene&) {}, "source_radius", {{"variant", "paper"}, {"homogeneous", "table"}, {"source_radius", "0.1"}});
  // A light at the camera is fine outside the medium, or softened.
  scene.media.clear();
  std::get<scene::PointLight>(scene.lights[0]).position = scene.camera.position;
  CHECK(reasons(scene).empty());
  scene.media = {homogeneous(0.2)};
  CHECK(reasons(scene, {{"source_radius", "0.1"}}).empty());
}

// Section 3: "can be applied to anisotropic scattering as well". Against quadrature, as close as isotropic scattering.
TEST_CASE("fogshop: Henyey-Greenstein's phase function", "[fogshop]") {
  const auto at = [](const char* name, double g) {
    auto scene = std::make_shared<Scene>(*airlight::test::scene_named(std::string("fogshop/") + name, 8, 6));
    scene->media[0].phase = scene::HenyeyGreenstein{g};
    finish(*scene);
    return scene;
  };
  const auto reference = deterministic::make_renderer();
  const scene::Renderer& truth = *reference;
  const Pairs rule{{"relative_tolerance", "1e-5"}};
  for (const char* name : {"f100_thin", "d100_thin"})
    for (const double g : {-0.5, 0.7}) {
      const auto scene = at(name, g);
      const Film exact = airlight::test::picture(truth, scene, rule);
      CAPTURE(name, g);
      const double slices = relative_l2(airlight::test::picture(method, scene), exact, "airlight");
      const double isotropic = relative_l2(airlight::test::picture(method, at(name, 0)),
                                           airlight::test::picture(truth, at(name, 0), rule), "airlight");
      CHECK(slices < 5 * isotropic + 1e-4);
      // The isotropic phase function gives another picture: g is not ignored.
      CHECK(relative_l2(airlight::test::picture(method, at(name, 0)), exact, "airlight") > 0.1);
    }
  // The paper's formula where the light is outside, to its own accuracy; on vectors as it is written out.
  const auto scene = at("f100_thin", 0.3);
  const Film film = airlight::test::picture(method, scene, {{"variant", "paper"}, {"eps_T", "1e-12"}});
  CHECK(relative_l2(film, airlight::test::picture(truth, scene, rule), "airlight") < 0.08);
  const auto& light = std::get<scene::PointLight>(scene->lights[0]);
  scene::GaussianSum fog = std::get<scene::GaussianSum>(scene->media[0].field);
  for (scene::Gaussian& g : fog.gaussians) g.amplitude *= scene->media[0].sigma_t[0];
  fogshop::PaperOptions options;
  options.g = 0.3;
  for (int y = 0; y < film.height; y += 2)
    for (int x = 0; x < film.width; x += 2) {
      const Ray ray = camera_ray(scene->camera, x + 0.5, y + 0.5, film.width, film.height);
      const double end = scene::ray_end(*scene, ray).t;
      CHECK(film.get("airlight", x, y)[0] ==
            Approx(fogshop::paper_airlight(fog, light.position, light.intensity[0], ray, end, options) *
                   scene->media[0].albedo[0])
                .epsilon(1e-5));
    }
}

TEST_CASE("fogshop leaves out what a scene does not need", "[fogshop]") {
  const auto stages = [](const Scene& scene, const Pairs& given) {
    return method.prepare(std::make_shared<const Scene>(scene), settings(given), {})->stages();
  };
  Scene scene = small_scene();
  for (const char* variant : {"paper", "S"}) {
    const Pairs given{{"variant", variant}};
    for (const auto& stage : stages(scene, given)) CHECK_FALSE(stage.kept);  // no medium
    const auto empty = render(scene, given);
    CHECK(empty.times.empty());
    CHECK(empty.counters.at("erf_evaluations") == 0);
    CHECK(empty.film.get("mean", 3, 3).isZero());
    CHECK(empty.film.get("transmittance", 3, 3).isOnes());

    Scene constant = scene;
    constant.media = {homogeneous(0.3)};
    CHECK(kept(stages(constant, given), "homogeneous term"));
    CHECK_FALSE(kept(stages(constant, given), "gaussians"));
    CHECK(render(constant, given).counters.at("erf_evaluations") == 0);

    Scene dark = scene;
    dark.lights.clear();
    dark.media = {gaussians({{Point3(0, 0, -4), 1, 0.5}}, 0.1)};
    CHECK_FALSE(kept(stages(dark, given), "airlight of Gaussians"));
    CHECK_FALSE(kept(stages(dark, given), variant == std::string("S") ? "light maps" : "depths to centres"));
    CHECK(render(dark, given).film.get("airlight", 6, 4).isZero());
  }
  scene.media = {gaussians({{Point3(0, 0, -4), 1, 0.5}})};
  CHECK_FALSE(kept(stages(scene, {{"variant", "paper"}}), "homogeneous term"));
  CHECK(kept(stages(scene, {}), "light maps"));
  CHECK_FALSE(kept(stages(scene, {{"light_depth", "exact"}}), "light maps"));
  CHECK_FALSE(kept(stages(scene, {}), "colour"));
  CHECK_FALSE(kept(stages(scene, {}), "surfaces"));
}

// A constant medium has a closed form: both variants must give it, on rays that end nowhere.
TEST_CASE("fogshop in a constant medium", "[fogshop]") {
  Scene scene = small_scene();
  scene.media = {homogeneous(0.3)};
  scene.media[0].sigma_t = Rgb(1, 0.5, 0.25);
  scene.media[0].albedo = Rgb(0.9, 0.8, 0.7);
  for (const char* variant : {"paper", "S"}) {
    const Film film = render(scene, {{"variant", variant}}).film;
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x) {
        const Ray ray = camera_ray(scene.camera, x + 0.5, y + 0.5, scene.width, scene.height);
        const Vec3 q = Point3(1, 2, -3) - ray.origin;
        const double along = q.dot(ray.direction), h = std::sqrt(q.squaredNorm() - along * along);
        const Rgb got = film.get("airlight", x, y);
        for (int c = 0; c < 3; ++c) {
          const double beta = 0.3 * scene.media[0].sigma_t[c];
          const double expected = (3 - c) * scene.media[0].albedo[c] *
                                  fogshop::homogeneous_airlight(fogshop::LightFromRay{along, h}, infinity, beta);
          CHECK(got[c] == Approx(expected).epsilon(2e-7));  // float layers
        }
        CHECK(film.get("transmittance", x, y).isZero());
      }
  }
}

// Eq. 29 on a wall: L = L_a + e^-T(v,p) L_p, with L_p = albedo/pi cos E e^-T(s,p).
TEST_CASE("fogshop lights surfaces through the medium", "[fogshop]") {
  Scene scene = small_scene();
  scene.media = {gaussians({{Point3(0.5, 0.2, -4), 1, 0.5}, {Point3(-1, 0.5, -3), 0.6, 1}}, 0.05)};
  scene.surfaces.push_back({"wall", scene::Plane{Point3(0, 0, -6), Vec3(0, 0, 1)}, scene::Lambert{Rgb(0.5, 0.6, 0.7)}});
  finish(scene);
  for (const char* variant : {"paper", "S"}) {
    const Film film = render(scene, {{"variant", variant}, {"eps_T", "1e-12"}}).film;
    for (int y = 0; y < scene.height; y += 2)
      for (int x = 0; x < scene.width; x += 3) {
        const Ray ray = camera_ray(scene.camera, x + 0.5, y + 0.5, scene.width, scene.height);
        const double t = -6 / ray.direction.z();
        const Point3 p = ray.at(t), s(1, 2, -3);
        const Vec3 to_light = (s - p).normalized();
        const Rgb visible = transmittance(scene.media, ray, {0, t});
        const Rgb lit = transmittance(scene.media, {p, to_light}, {0, (s - p).norm()});
        const Rgb expected =
            visible * lit * Rgb(0.5, 0.6, 0.7) / pi * to_light.z() / (s - p).squaredNorm() * Rgb(3, 2, 1);
        CHECK(((film.get("surface", x, y) - expected).abs() <= 2e-6 * expected).all());
        CHECK(((film.get("transmittance", x, y) - visible).abs() <= 1e-6).all());
        CHECK(((film.get("mean", x, y) - film.get("airlight", x, y) - film.get("surface", x, y)).abs() <= 1e-6).all());
      }
  }
}

TEST_CASE("fogshop gives the same bits on one thread and on two", "[fogshop]") {
  const Scene scene = scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/a100.toml");
  for (const Pairs& given : {Pairs{{"variant", "paper"}}, Pairs{{"K", "12"}, {"edges", "plain"}}, Pairs{}}) {
    const Film one = render(scene, given, 1).film, two = render(scene, given, 2).film;
    CHECK(one.layers == two.layers);
  }
}

// A length unit of 2^k metres changes nothing but the unit of radiance.
TEST_CASE("fogshop does not know metres", "[fogshop]") {
  const auto scaled = [](double unit) {
    Scene scene = small_scene();
    scene.camera.position *= unit;
    auto& light = std::get<scene::PointLight>(scene.lights[0]);
    light.position *= unit;
    light.intensity *= unit * unit;
    scene.media = {gaussians(
        {{unit * Point3(0.5, 0.2, -4), unit, 0.5 / unit}, {unit * Point3(-1, 0.5, -3), unit, 1 / unit}}, 0.05 / unit)};
    return scene;
  };
  for (const char* variant : {"paper", "S"}) {
    const Film metres = render(scaled(1), {{"variant", variant}}).film;
    for (double unit : {1.0 / 1024, 1024.0}) {
      const Film other = render(scaled(unit), {{"variant", variant}}).film;
      CHECK(relative_l2(other.layer("airlight"), metres.layer("airlight")) <= 1e-6);
    }
  }
}

// Equal albedos keep one number for all: the same list, and a picture with the bits of one medium.
TEST_CASE("fogshop: equal albedos cost nothing", "[fogshop]") {
  Scene one = small_scene(), two = one;
  const scene::Gaussian a{Point3(0.5, 0.2, -4), 1, 0.5}, b{Point3(-1, 0.5, -3), 0.6, 1};
  one.media = {gaussians({a, b}, 0.05)};
  two.media = {gaussians({a}, 0.05), gaussians({b})};
  for (Scene* scene : {&one, &two})
    for (auto& medium : scene->media) medium.albedo = Rgb(0.9, 0.8, 0.7);
  for (const char* variant : {"paper", "S"}) {
    const Pairs given{{"variant", variant}};
    CHECK(render(one, given).film.layers == render(two, given).film.layers);
    const auto prepared = method.prepare(std::make_shared<const Scene>(two), settings(given), {});
    CHECK_FALSE(kept(prepared->stages(), "colours of scattering"));
  }
  two.media[1].albedo = Rgb(0.9, 0.8, 0.6);
  const auto prepared = method.prepare(std::make_shared<const Scene>(two), settings({}), {});
  CHECK(kept(prepared->stages(), "colours of scattering"));
}

}  // namespace fogshop_test
