// The layer of the sun: its map of columns, closed forms, the deterministic reference, the path tracer.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "experiments/judging/equality.h"
#include "methods/wavelet_fog/sun_map.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "reference/deterministic/renderer.h"
#include "reference/path_tracer/renderer.h"
#include "scene/media/fogmap.h"
#include "tests/methods/wavelet_fog/sun_scenes.h"

namespace sun_test {

using namespace airlight;
using namespace airlight::test;

namespace {

const wavelet_fog::WaveletFog method;

std::vector<scene::HeightProfile> profiles() {
  return {scene::SameAtAllHeights{}, scene::Layers{{-1, 0.5, 2, 4}, {0.25, 1, 0.5, 0}},
          scene::ExponentialFall{0.3, 0.8}};
}

scene::Medium turned_fog(int degree, const scene::HeightProfile& profile, const scene::Region& region) {
  std::mt19937_64 random(31 + degree);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values(24 * 20);
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 24; ++i)
      values[j * 24 + i] = std::max(0.0, std::sin(0.5 * i) * std::sin(0.6 * j) + 0.4 * uniform(random));
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = scene::SplineMap(degree, {{0, 0}, {24, 20}}, values);
  fog->profile = profile;
  fog->x0 = -9, fog->z0 = 2, fog->cell = 0.7;
  fog->cos_turn = std::cos(0.4), fog->sin_turn = std::sin(0.4);
  scene::Medium medium;
  medium.field = scene::FogmapPointer(fog);
  medium.region = region;
  return medium;
}

}  // namespace

TEST_CASE("sun: a map's columns converge to the exact ones at every height", "[wavelet_fog][sun][slow]") {
  const scene::Region regions[] = {scene::Unbounded{}, scene::Slab{Vec3::UnitY(), -3, 3}, Box{{-6, -2, 4}, {6, 2, 14}},
                                   scene::Sphere{{0, 0, 8}, 5}};
  for (int degree = 0; degree <= 3; ++degree)
    for (const scene::HeightProfile& profile : profiles())
      for (const scene::Region& region : regions)
        for (const double elevation : {-0.4, 0.0, 0.02, 0.3, 0.8, 1.2, 1.4, 1.5697, 0.5 * pi}) {
          if (elevation < 0 && profile.index() == 2) continue;  // refused
          const scene::Medium medium = turned_fog(degree, profile, region);
          const Vec3 sun = Vec3(std::cos(elevation) * 0.6, std::sin(elevation), std::cos(elevation) * 0.8).normalized();
          CAPTURE(degree, scene::profile_name(profile), scene::region_name(region), elevation);
          double error[2];  // of 1 and 1/4 cells between entries: root mean square, relative
          for (int fine = 0; fine < 2; ++fine) {
            std::mt19937_64 random(7);
            std::uniform_real_distribution<double> uniform(-1, 1);
            const wavelet_fog::SunMap map(medium, sun, fine ? 0.25 : 1, {1, {}});
            double squares = 0, scale = 0;
            for (int i = 0; i < 2000; ++i) {
              const double depth = uniform(random), height = uniform(random), across = uniform(random);
              const Point3 x(8 * across, 3 * height, 9 + 8 * depth);
              const double exact = density_integral(medium, {x, sun}, {0, infinity}), got = map.column(x);
              squares += (got - exact) * (got - exact);
              scale += exact * exact;
            }
            REQUIRE(scale > 10);
            error[fine] = std::sqrt(squares / scale);
          }
          // Where the way over the ground is two cells at most, it is walked. Else the order of convergence goes with the
          // degree: f jumps at 0, and bends at 1, on a map whose neighbours differ as much as they can.
          const double most[] = {0.05, 0.004, 6e-4, 2e-4}, gain[] = {2, 8, 30, 50};
          CHECK(error[1] <= most[degree]);
          CHECK(error[1] <= std::max(1e-14, error[0] / gain[degree]));
        }
}

TEST_CASE("sun: pictures equal the quadrature's", "[wavelet_fog][sun]") {
  for (const SunCase& c : sun_cases) {
    const auto scene = sun_scene(c, 24, 18);
    CAPTURE(c.name);
    const scene::Film film = picture(method, scene, {{"sun", "true"}, {"sun_step", "0.25"}}, 0);
    const scene::Film truth = picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-6"}}, 0);
    const double error = relative_l2(film, truth, "airlight");
    CHECK(error <= c.most);
    CHECK(relative_l2(film, truth, "mean") <= c.most);
    if (c.houses) {  // what is left is shadows that fall between two rays
      const Given finer = {{"sun", "true"}, {"sun_step", "0.25"}, {"shadow_steps", "4096"}};
      CHECK(relative_l2(picture(method, scene, finer, 0), truth, "airlight") <= 1e-5);
    }
  }
}

namespace {

// False alarms: 1e-3 for all scenes together.
void equal_the_path_tracer(const std::vector<SunCase>& scenes) {
  const double alpha = 1e-3 / double(std::size(sun_cases));
  for (const SunCase& c : scenes) {
    const auto scene = sun_scene(c, 24, 18);
    CAPTURE(c.name);
    const scene::Film film = picture(method, scene, {{"sun", "true"}, {"sun_step", "0.25"}}, 0);
    const scene::Film traced =
        picture(path_tracer::PathTracer(), scene, {{"samples", c.samples}, {"max_order", "1"}}, 0);
    const experiments::Equality e = experiments::compare_equal(film, traced, "mean", {}, alpha);
    if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("{}: {}\n", c.name, experiments::text(e));
    CHECK(e.equal);
    CHECK(e.detectable_bias < 0.03);
    // Twice the bias that it must be able to detect: it does.
    scene::Film darker = film;
    for (float& v : darker.layers["mean"]) v *= 0.94f;
    CHECK_FALSE(experiments::compare_equal(darker, traced, "mean", {}, alpha).equal);
  }
}

}  // namespace

TEST_CASE("sun: pictures equal the path tracer's, with houses and without", "[wavelet_fog][sun][slow]") {
  equal_the_path_tracer({std::begin(sun_cases)[0], std::end(sun_cases)[-1]});
}

TEST_CASE("sun: pictures of all other scenes equal the path tracer's", "[wavelet_fog][sun][thorough]") {
  equal_the_path_tracer({std::begin(sun_cases) + 1, std::end(sun_cases) - 1});
}

TEST_CASE("sun: in even fog under a flat top the light is a closed form", "[wavelet_fog][sun]") {
  // A map of ones over 20 x 20 cells of degree 0, in a box 3 m high: an even medium. All light comes in by its top. From
  // 1 m below that, along
  // (d_x, d_y), the way to the sun is (1 - t d_y) / w_y, and
  //   L = albedo sigma p E exp(-sigma / w_y) (1 - exp(-a s)) / a,  a = sigma (1 - d_y / w_y), s the length in the fog.
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = scene::SplineMap(0, {{0, 0}, {20, 20}}, std::vector<double>(400, 1));
  fog->x0 = fog->z0 = -20;
  fog->cell = 2;
  scene::Scene scene;
  scene.media.resize(1);
  scene::Medium& medium = scene.media[0];
  medium.field = scene::FogmapPointer(fog);
  medium.region = Box{{-20, -2, -20}, {20, 1, 20}};
  medium.albedo = {0.9, 0.6, 0.3};
  medium.phase = scene::HenyeyGreenstein{0.5};
  const Vec3 w = Vec3(0.6, 0.5, 0.3).normalized();
  scene.lights = {scene::DirectionalLight{w, {3, 2, 1}}};
  for (const Rgb& sigma : {Rgb(0.01, 0.1, 1), Rgb(3, 10, 1e-9)})
    for (const double dy : {-0.4, -0.15, 0.1, 0.7}) {
      medium.sigma_t = sigma;
      scene.camera = scene::look_at({0, 0, 0}, Vec3(1, dy, 0.2), Vec3::UnitY());
      scene.width = scene.height = 1;
      finish(scene);
      const Vec3 d = Vec3(1, dy, 0.2).normalized();
      const double s = d[1] > 0 ? 1 / d[1] : -2 / d[1];
      const double p = phase_value(medium.phase, w.dot(d));
      const Rgb a = sigma * (1 - d[1] / w[1]);
      const Rgb expected = medium.albedo * sigma * p * Rgb(3, 2, 1) * (-sigma / w[1]).exp() *
                           a.unaryExpr([&](double x) { return -std::expm1(-x * s) / x; });
      const scene::Film film = render(method, scene, {{"sun", "true"}}).film;
      for (int c = 0; c < 3; ++c) {
        CAPTURE(sigma.transpose(), dy, c);
        CHECK(film.layer("airlight")[c] == Approx(expected[c]).epsilon(1e-6));
      }
    }
}

// The lit part may be as thin as 1e-8 of a cell.
TEST_CASE("sun: fog of any extinction sends back what the quadrature says", "[wavelet_fog][sun]") {
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = scene::SplineMap(2, {{0, 0}, {4, 4}},
                              {0.5, 1, 0.6, 0.8, 0.4, 0.3, 0.9, 0.7, 0.5, 0.2, 1, 0.9, 0.3, 0.6, 0.8, 0.5});
  fog->x0 = fog->z0 = -8;
  fog->cell = 4;
  auto scene = std::make_shared<scene::Scene>();
  scene->media.resize(1);
  scene->media[0].field = scene::FogmapPointer(fog);
  scene->media[0].region = Box{{-9, -2, -9}, {9, 2, 9}};
  scene->lights = {scene::DirectionalLight{Vec3(0.3, 0.8, 0.4).normalized(), Rgb::Constant(2)}};
  scene->camera = scene::look_at({0, 8, 25}, {0, 0, 0}, Vec3::UnitY());
  scene->width = 16, scene->height = 12;
  for (const double extinction : {1e3, 1e5, 1e7, 1e9}) {
    scene->media[0].sigma_t = Rgb(extinction, 0.5 * extinction, 2 * extinction);
    finish(*scene);
    CAPTURE(extinction);
    const scene::Film truth = picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-6"}}, 0);
    CHECK(relative_l2(picture(method, scene, {{"sun", "true"}}, 0), truth, "airlight") <= 1e-5);
  }
}

TEST_CASE("sun: several suns and maps over each other, a ray without end", "[wavelet_fog][sun]") {
  const auto scene = sun_scene(sun_cases[0], 16, 12);
  scene->media.push_back(sun_scene(sun_cases[4], 16, 12)->media[0]);
  scene->lights.push_back(scene::DirectionalLight{Vec3(-0.3, 0.5, 0.6).normalized(), {1, 2, 3}});
  finish(*scene);
  const auto truth_of = [&] {
    return picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-7"}}, 0);
  };
  CHECK(relative_l2(picture(method, scene, {{"sun", "true"}}, 0), truth_of()) <= 1e-4);
  // Straight up in a map without profile or region: no end, and no light but what comes in from the side.
  auto fog = std::make_shared<scene::Fogmap>(*std::get<scene::FogmapPointer>(scene->media[0].field));
  fog->profile = scene::SameAtAllHeights{};
  scene->media = {scene->media[0]};
  scene->media[0].field = scene::FogmapPointer(fog);
  scene->media[0].region = scene::Unbounded{};
  scene->camera = scene::look_at({3, 1, 2}, {3, 9, 2}, Vec3::UnitX());
  scene->width = scene->height = 1;
  finish(*scene);
  const scene::Film film = picture(method, scene, {{"sun", "true"}}), truth = truth_of();
  CHECK(truth.layer("airlight")[0] > 1e-3);
  CHECK(relative_l2(film, truth) <= 1e-4);
}

TEST_CASE("sun: every layer is that of the quadrature, and their sum; threads change nothing", "[wavelet_fog][sun]") {
  const auto scene = scene_named("wavelet_fog/valley", 32, 24);
  const Given given = {{"sun", "true"}, {"sun_step", "0.25"}};
  const scene::Film film = picture(method, scene, given, 1);
  const scene::Film truth = picture(*deterministic::make_renderer(), scene, {{"relative_tolerance", "1e-6"}}, 0);
  for (const char* layer : {"transmittance", "ambient", "surface", "airlight", "mean"}) {
    CAPTURE(layer);
    CHECK(relative_l2(film, truth, layer) <= 2e-5);
  }
  CHECK(picture(method, scene, given, 3).layers == film.layers);
  // The variant's error in transmittance does not affect the sun, which has its own way.
  Given coarse = given;
  coarse["variant"] = "tele";
  const scene::Film other = picture(method, scene, coarse, 0);
  CHECK(other.layer("airlight") == film.layer("airlight"));
  CHECK(other.layer("transmittance") != film.layer("transmittance"));
}

TEST_CASE("sun: what it cannot do is refused by name, what is not there left out", "[wavelet_fog][sun]") {
  const auto scene = sun_scene(sun_cases[3], 8, 6);
  const auto reasons = [&](const Given& given) { return method.supports(*scene, {method.settings(), given}); };
  const auto refused = [&](const Given& given, const std::string& word) {
    const auto all = reasons(given);
    REQUIRE(all.size() == 1);
    CHECK_THAT(all[0], Catch::Contains(word));
  };
  CHECK(reasons({{"sun", "true"}}).empty());
  refused({{"sun", "true"}, {"sun_step", "0.01"}}, "sun_step = 0.01");
  scene->lights[0] = scene::DirectionalLight{Vec3(1, -0.1, 0).normalized(), Rgb::Ones()};
  refused({{"sun", "true"}}, "light 0 shines from below the horizon");
  CHECK(reasons({}).empty());
  scene->lights[0] = scene::PointLight{{0, 5, 0}, Rgb::Ones(), 0};
  refused({{"sun", "true"}}, "light 0 is point");
  scene->lights = {scene::DirectionalLight{Vec3::UnitY(), Rgb::Zero()}};
  const auto prepared = method.prepare(scene, {method.settings(), {{"sun", "true"}}}, {1, {}});
  for (const scene::Stage& stage : prepared->stages())
    if (stage.name == "airlight") CHECK((!stage.kept && stage.reason == "no directional light shines"));
  CHECK(prepared->render(view_of(*scene), {1, {}}).film.layers.count("airlight") == 0);
}

}  // namespace sun_test
