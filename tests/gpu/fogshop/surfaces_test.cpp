// Surfaces of Fogshop in shaders against the CPU: first hits, shadows, reflected light, everything through the medium.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/fogshop/fogshop.h"
#include "methods/fogshop/fogshop.h"
#include "scene/geometry/brdf_table.h"
#include "scene/geometry/shapes.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/fogshop/small_sky.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"
#include "tests/scene/geometry_scenes.h"

namespace surfaces_test {

using namespace airlight;
using Pairs = std::map<std::string, std::string>;
using scene::Scene;

namespace {

// One scene and settings on both sides.
struct Pair {
  std::shared_ptr<const Scene> scene;
  scene::Film a, b;

  Pair(const Scene& given_scene, const Pairs& given) : scene(std::make_shared<const Scene>(given_scene)) {
    a = airlight::test::picture(fogshop::Fogshop(), scene, given);
    b = airlight::test::picture(gpu::fogshop::Fogshop(), scene, given);
  }
};

struct Difference {
  double p99 = 0, most = 0;  // of |b - a| / (a + 1 % of the greatest a), per value
};

Difference compare(const Pair& pair, const std::string& layer) {
  REQUIRE(*std::max_element(pair.a.layer(layer).begin(), pair.a.layer(layer).end()) > 0);
  return {gpu::test::p99(pair.a, pair.b, layer), gpu::test::quantile(pair.a, pair.b, layer, 1)};
}

scene::Material satin() {
  const std::string path = AIRLIGHT_SOURCE_DIR "/experiments/data/synthetic_satin.brdf";
  return scene::Tabulated{std::make_shared<const scene::BrdfTable>(scene::read_brdf_table(path))};
}

// Every pixel shows the same surface, in the same light or shadow.
void check(const Scene& scene, const Pairs& given) {
  std::vector<std::string> layers = {"airlight", "surface", "transmittance", "mean"};
  if (given.count("reflectance") && given.at("reflectance") != "direct") layers.push_back("reflected_airlight");
  const Pair pair(scene, given);
  for (const std::string& layer : layers) {
    const Difference d = compare(pair, layer);
    CAPTURE(scene.name, given, layer, d.p99, d.most);
    CHECK(d.p99 < 3.3e-5);
    CHECK(d.most < 2.2e-4);
    if (std::getenv("AIRLIGHT_TEST_FIGURES"))
      fmt::print("{} {} {}: 99 % {:.1e}, most {:.1e}\n", scene.name,
                 given.count("reflectance") ? given.at("reflectance") : "", layer, d.p99, d.most);
  }
}

// A torus, a glossy ball and a box on the ground, two lamps, banks of fog over a thin constant.
Scene things(const Rgb& sigma_t) {
  Scene scene;
  scene.name = (sigma_t == 1).all() ? "things in grey fog" : "things in coloured fog";
  scene.width = 36;
  scene.height = 27;
  scene.camera = scene::look_at({1.2, 1.7, 3.2}, {0.1, 0, 0}, {0, 1, 0});
  scene.lights.emplace_back(scene::PointLight{{0.8, 2.2, 1.1}, Rgb(9, 8, 7), 0});
  scene.lights.emplace_back(scene::PointLight{{-1.6, 1.1, 0.9}, Rgb(1, 2, 4), 0.08});
  scene::Medium fog;
  scene::GaussianSum sum;
  sum.constant = 0.05;
  sum.gaussians = {{{0, 0, 0}, 0.8, 0.5}, {{1, 0.5, -0.5}, 0.6, 0.8}, {{-0.8, 0.2, 0.9}, 0.5, 0.7}};
  fog.field = sum;
  fog.sigma_t = sigma_t;
  fog.albedo = Rgb(0.95, 0.9, 0.8);
  scene.media.push_back(fog);
  scene.surfaces = {
      {"torus", scene::torus(32, 16), scene::Lambert{Rgb(0.7, 0.5, 0.3)}},
      {"ball", scene::Sphere{{0.4, 0.7, 0.3}, 0.35}, scene::Phong{Rgb(0.2, 0.3, 0.4), Rgb::Constant(0.5), 20}},
      {"ground", scene::Plane{{0, -0.6, 0}, Vec3(0, 1, 0)}, scene::Lambert{Rgb(0.4, 0.5, 0.4)}},
      {"box", scene::make_box({{-0.3, -0.6, -0.2}, {0.2, 0.3, 0.3}}),
       scene::Phong{Rgb::Constant(0.3), Rgb(0.3, 0.2, 0.1), 5}},
  };
  finish(scene);
  return scene;
}

}  // namespace

DEVICE_TEST_CASE("fogshop: surfaces on the GPU agree with the CPU", "[gpu]") {
  for (const Rgb& sigma_t : {Rgb(1, 1, 1), Rgb(1, 0.6, 0.3)})
    for (const char* reflectance : {"direct", "npsf", "npsfT"})
      check(things(sigma_t), {{"erf", "erf10"}, {"reflectance", reflectance}});
  Scene scene = things(Rgb(1, 0.5, 0));
  check(scene, {{"erf", "erf10"}, {"variant", "paper"}, {"reflectance", "npsfT"}, {"sh_order", "12"}});
  scene.name = "from above";
  scene.camera.kind = scene::Camera::Kind::orthographic;
  scene.camera.height = 3;
  check(scene, {{"erf", "erf10"}, {"reflectance", "npsfT"}, {"sh_order", "1"}});
  scene.name = "in vacuum";
  scene.media.clear();
  const Difference d = compare({scene, {}}, "mean");
  CHECK(d.most < 1e-5);
}

// Tables, lobes sharper than a quadrature in the shader would resolve, the form without harmonics, shadows of scattered
// light.
DEVICE_TEST_CASE("fogshop: every reflectance on the GPU agrees with the CPU", "[gpu][thorough]") {
  for (const Rgb& sigma_t : {Rgb(1, 1, 1), Rgb(1, 0.6, 0)}) {
    Scene scene = things(sigma_t);
    scene.surfaces[0].material = scene::Phong{Rgb(0.3, 0.2, 0.1), Rgb::Constant(0.6), 300};
    scene.surfaces[2].material = scene::Phong{Rgb::Constant(0.1), Rgb::Constant(0.4), 0};
    finish(scene);
    check(scene, {{"erf", "erf10"}, {"reflectance", "sun"}});
    scene.surfaces[1].material = satin();
    scene.surfaces[3].material = satin();
    finish(scene);
    const bool grey = (sigma_t == 1).all();
    for (const char* order : grey ? std::vector{"6"} : std::vector{"1", "4", "12"})
      check(scene, {{"erf", "erf10"}, {"reflectance", "npsfT"}, {"sh_order", order}});
    check(scene, {{"erf", "erf10"}, {"reflectance", "npsf"}, {"sh_order", grey ? "12" : "4"}, {"prt", "true"}});
  }
}

// Eqs. 26 and 27, and the background: a map, harmonics and a constant, with and without lamps and visibility.
DEVICE_TEST_CASE("fogshop: surfaces under an environment on the GPU agree with the CPU", "[gpu][slow][thorough]") {
  const Mat3 turned = Eigen::AngleAxisd(0.7, Vec3(0.3, 1, 0.2).normalized()).toRotationMatrix();
  const std::vector<scene::Light> skies = {
      scene::make_map_environment(gpu::test::small_courtyard(), turned, Rgb(1, 0.9, 0.8), "courtyard"),
      scene::make_sh_environment({Rgb(3, 3, 4), Rgb(-1, -0.8, -1), Rgb(0.2, 0.2, 0.1), Rgb(0.4, 0.1, 0.1)}, turned,
                                 Rgb(1, 0.9, 0.8)),
      scene::make_constant_environment(Rgb(0.5, 0.7, 1))};
  Scene scene = things(Rgb(1, 0.6, 0.3));
  scene.surfaces[1].material = satin();
  scene.surfaces[2].shape = scene::make_box({{-2, -0.8, -2}, {2, -0.6, 2}});  // the sky is seen beside it
  const std::vector<scene::Light> lamps = scene.lights;
  std::get<scene::GaussianSum>(scene.media[0].field).constant = 0.02;
  for (const scene::Light& sky : skies) {
    scene.name = std::get<scene::EnvironmentLight>(sky).source;
    scene.lights = {sky};
    finish(scene);
    check(scene, {{"erf", "erf10"}, {"environment_distance", "20"}});
    check(scene, {{"erf", "erf10"}, {"environment_distance", "20"}, {"reflectance", "npsfT"}, {"sh_order", "12"}});
    scene.lights.insert(scene.lights.end(), lamps.begin(), lamps.end());
    scene.lights.push_back(skies[1]);
    finish(scene);
    check(scene, {{"erf", "erf10"}, {"environment_distance", "20"}, {"reflectance", "npsf"}, {"prt", "true"}});
    check(scene,
          {{"erf", "erf10"}, {"environment_distance", "20"}, {"reflectance", "npsfT"}, {"environment_psf", "npsf"}});
    Scene vacuum = scene;
    vacuum.media.clear();
    const Difference d = compare({vacuum, {{"prt", "true"}}}, "mean");
    CHECK(d.most < 1.2e-4);
  }
}

DEVICE_TEST_CASE("fogshop: light between surfaces on the GPU agrees with the CPU", "[gpu]") {
  Scene scene = things(Rgb::Ones());
  scene.media.clear();
  scene.lights = {scene::make_constant_environment(Rgb(0.5, 0.7, 1))};
  scene.surfaces[2].shape = scene::make_box({{-2, -0.8, -2}, {2, -0.6, 2}});
  finish(scene);
  const Pairs prt{{"prt", "true"}, {"prt_rays", "64"}, {"sh_order", "4"}};
  Pairs bounces = prt;
  bounces["prt_bounces"] = "2";
  const Pair with(scene, bounces), without(scene, prt);
  CHECK(compare(with, "mean").most < 1.2e-4);
  CHECK(airlight::test::relative_l2(with.a, without.a, "mean") > 0.02);
}

// 3008 Gaussians and one lamp: tiles choose from the lists of squares, and points of a tile share the list before the lamp.
DEVICE_TEST_CASE("fogshop: a box full of fog on the GPU agrees with the CPU", "[gpu]") {
  const Scene scene = scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/table1/box.toml",
                                        {{"film.width", "150"}, {"film.height", "110"}});
  for (const char* erf : {"erf10", "precise"})
    check(scene, {{"erf", erf}, {"variant", "paper"}, {"reflectance", "npsf"}});
}

DEVICE_TEST_CASE("fogshop: the elephant on the GPU agrees with the CPU", "[gpu]") {
  const Scene scene = scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/elephant_gaussians.toml",
                                        {{"film.width", "120"}, {"film.height", "90"}});
  check(scene, {{"erf", "erf10"}, {"reflectance", "npsfT"}});
}

// From within a sphere, with lamps within and without, and a plane that is seen from behind its normal.
DEVICE_TEST_CASE("fogshop: shadows of a surface on itself", "[gpu]") {
  Scene scene;
  scene.width = scene.height = 32;
  scene.camera = scene::look_at({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0});
  scene.lights.emplace_back(scene::PointLight{{0.2, 0.3, 0}, Rgb::Ones(), 0});
  scene.lights.emplace_back(scene::PointLight{{0, 3, 0}, Rgb::Constant(30), 0});
  for (const scene::Shape& shape :
       {scene::Shape{scene::Sphere{{0, 0, 0}, 1}}, {scene::Plane{{0, 0, -1}, {0, 0, -1}}}}) {
    scene.surfaces = {{"one", shape, scene::Lambert{}}};
    finish(scene);
    const Difference d = compare({scene, {}}, "surface");
    CAPTURE(d.p99, d.most);
    CHECK(d.most < 1e-5);
  }
}

DEVICE_TEST_CASE("fogshop: edges of shadows are exact on the device", "[gpu]") {
  Scene scene = scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/elephant_gaussians.toml",
                                  {{"film.width", "160"}, {"film.height", "120"}});
  scene.media.clear();
  CHECK(compare(Pair(scene, {}), "surface").most < 2e-6);
}

}  // namespace surfaces_test
