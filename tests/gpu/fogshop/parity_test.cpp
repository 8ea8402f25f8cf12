// Fogshop on the GPU against Fogshop on the CPU: same variant, same settings, same picture to single precision.
#include <fmt/ranges.h>

#include <algorithm>

#include "gpu/fogshop/fogshop.h"
#include "gpu/program.h"
#include "methods/fogshop/fogshop.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/fogshop/small_sky.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"

namespace parity_test {

using namespace airlight;
using gpu::test::p99;
using Pairs = std::map<std::string, std::string>;
using airlight::test::picture;

namespace {

std::shared_ptr<const scene::Scene> scene_named(const std::string& name) {
  return airlight::test::scene_named("fogshop/" + name, 16, 12);
}

const fogshop::Fogshop cpu;
const gpu::fogshop::Fogshop gpu_method;

// The 99th percentiles of layers below their bounds.
void agree(const std::shared_ptr<const scene::Scene>& scene, const Pairs& given, double airlight,
           double transmittance) {
  const scene::Film a = picture(cpu, scene, given), b = picture(gpu_method, scene, given);
  const std::string name = fmt::format("{} {}", scene->name, fmt::join(given, " "));
  gpu::test::agree(name, a, b, {airlight}, {"airlight"});
  gpu::test::agree(name, a, b, {transmittance}, {"transmittance"});
}

void agree(const std::vector<const char*>& names) {
  for (const char* name : names) {
    const auto scene = scene_named(name);
    for (Pairs given : {Pairs{{"variant", "paper"}}, Pairs{{"K", "24"}}, Pairs{{"erf", "precise"}},
                        Pairs{{"K", "12"}, {"extrapolate", "false"}},
                        Pairs{{"K", "13"}, {"extrapolate", "false"}, {"edges", "plain"}}}) {
      given.emplace("erf", "erf10");  // one approximation on both sides; `precise` differs by 3.3e-7
      agree(scene, given, 2.4e-5, 7e-6);
    }
  }
}

}  // namespace

// A constant, a light in the middle, the halo of one close by, thick fog. The gates of fogshop/parity_paper and
// parity_slices see all scenes of both tests, within 2e-3.
DEVICE_TEST_CASE("fogshop: GPU agrees with CPU", "[gpu]") {
  agree({"f100_constant", "a100", "halo_near", "d100_thick"});
}

DEVICE_TEST_CASE("fogshop: GPU agrees with CPU in six more scenes", "[gpu][thorough]") {
  agree({"f100_thin", "f100", "a30", "halo_far", "tube", "count_251"});
}

DEVICE_TEST_CASE("fogshop: GPU agrees with CPU on Henyey-Greenstein's phase function", "[gpu]") {
  for (const char* name : {"f100_thin", "d100_thick"})
    for (const double g : {-0.5, 0.7})
      for (const char* variant : {"paper", "S"}) {
        auto scene = std::make_shared<scene::Scene>(*scene_named(name));
        scene->media[0].phase = scene::HenyeyGreenstein{g};
        finish(*scene);
        agree(scene, {{"variant", variant}, {"erf", "erf10"}}, 2.4e-5, 2.4e-5);
      }
}

DEVICE_TEST_CASE("fogshop: GPU agrees with CPU under forty lights", "[gpu]") {
  auto scene = std::make_shared<scene::Scene>(*scene_named("a30"));
  const scene::PointLight light = std::get<scene::PointLight>(scene->lights[0]);
  scene->lights.clear();
  for (int i = 0; i < 40; ++i)
    scene->lights.emplace_back(
        scene::PointLight{light.position + 0.5 * Vec3(std::sin(i), std::cos(1.7 * i), std::sin(2.3 * i)),
                          light.intensity * (0.01 + 0.001 * i), light.radius});
  finish(*scene);
  for (const char* variant : {"paper", "S"}) agree(scene, {{"variant", variant}, {"erf", "erf10"}}, 2.4e-5, 7e-6);
}

// Where a light map would miss small Gaussians, both take sums.
DEVICE_TEST_CASE("fogshop: a puff in a bank, GPU agrees with CPU", "[gpu]") {
  auto scene = std::make_shared<scene::Scene>();
  scene->width = 24;
  scene->height = 18;
  scene->camera = scene::look_at(Point3(0, 1, 6), Point3(0, 1, 0), Vec3::UnitY());
  scene->lights = {scene::PointLight{Point3(0, 1, 0), Rgb::Constant(4), 0}};
  scene::Medium medium;
  medium.field = scene::GaussianSum{{{Point3(0, 1, 0), 0.1, 10}, {Point3(0.5, 1, 0), 200, 0.003}}, 0, infinity};
  scene->media = {medium};
  finish(*scene);
  agree(scene, {}, 2.4e-5, 2.4e-5);
}

namespace {

// The sky alone, with a point light, over a constant up to its distance, on surfaces; every PSF. Either scene i with settings i, or
// all other pairs.
void agree_under_environment(bool others) {
  const auto from = [](const char* name, scene::Overrides overrides) {
    overrides.insert({{"film.width", "12"}, {"film.height", "9"}});
    return std::make_shared<scene::Scene>(
        scene::load_scene(std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/") + name, overrides));
  };
  auto sky = from("environment_cloud.toml", {{"medium.0.sigma_t", "[0.25, 0.15, 0.05]"}, {"medium.0.albedo", "0.8"}});
  sky->lights[0] = gpu::test::with_small_map(std::get<scene::EnvironmentLight>(sky->lights[0]));
  finish(*sky);
  auto both = std::make_shared<scene::Scene>(*sky);
  both->lights.emplace_back(scene::PointLight{Point3(4, 5, 3), Rgb(300, 200, 100), 0.5});
  both->surfaces.push_back({"floor", scene::Plane{Point3(0, -1, 0), Vec3::UnitY()},
                            scene::Phong{Rgb::Constant(0.3), Rgb::Constant(0.3), 5}});
  finish(*both);
  auto constant = std::make_shared<scene::Scene>(*both);
  std::get<scene::GaussianSum>(constant->media[0].field).constant = 0.1;
  finish(*constant);
  auto alone = std::make_shared<scene::Scene>(*constant);
  std::get<scene::GaussianSum>(alone->media[0].field).gaussians.clear();
  finish(*alone);
  const std::shared_ptr<scene::Scene> scenes[] = {sky, both, constant, alone};
  const Pairs settings[] = {{{"environment_psf", "ball"}},
                            {{"environment_psf", "npsf"}, {"variant", "paper"}},
                            {{"environment_airlight", "everywhere"}, {"downsample", "2"}},
                            {{"environment_psf", "npsfT"}, {"sh_order", "12"}}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if ((i != j) != others) continue;
      const auto& scene = scenes[i];
      Pairs given = settings[j];
      given.insert({{"erf", "erf10"}, {"reflectance", "npsfT"}});
      if (scene == constant || scene == alone) given["environment_distance"] = "40";
      const scene::Film a = picture(cpu, scene, given), b = picture(gpu_method, scene, given);
      CAPTURE(scene == sky, scene == both, scene == constant, given);
      CHECK(*std::max_element(a.layer("airlight").begin(), a.layer("airlight").end()) > 0);
      gpu::test::agree("sky", a, b, {7e-5}, {"airlight", "transmittance", "surface", "mean"});
    }
}

}  // namespace

DEVICE_TEST_CASE("fogshop: GPU agrees with CPU under an environment", "[gpu]") { agree_under_environment(false); }

DEVICE_TEST_CASE("fogshop: GPU agrees with CPU under an environment, other settings of each scene", "[gpu][thorough]") {
  agree_under_environment(true);
}

// llvmpipe ends loops after 65535 iterations in all: what would need more is refused, what comes close is whole.
DEVICE_TEST_CASE("fogshop: many Gaussians and slices on the device", "[gpu][thorough]") {
  const auto scene = scene_named("count_967");
  const Pairs many{{"K", "256"}};
  CHECK(p99(picture(fogshop::Fogshop(), scene, many), picture(gpu::fogshop::Fogshop(), scene, many), "airlight") <
        2.2e-6);
  Pairs exact{{"K", "128"}, {"light_depth", "exact"}};
  if (context.software()) {
    CHECK_THROWS_AS(picture(gpu::fogshop::Fogshop(), scene, exact), Unavailable);
    exact["K"] = "48";
  }
  CHECK(p99(picture(fogshop::Fogshop(), scene, exact), picture(gpu::fogshop::Fogshop(), scene, exact), "airlight") <
        2.2e-6);
}

DEVICE_TEST_CASE("fogshop: what a scene has not costs no dispatch", "[gpu]") {
  const gpu::fogshop::Fogshop method;
  auto scene = std::make_shared<scene::Scene>(*scene_named("f100"));
  const auto dispatches = [&](const Pairs& given) {
    const long before = gpu::Program::dispatches();
    picture(method, scene, given);
    return gpu::Program::dispatches() - before;
  };
  // One light map, two of lists by direction; distances, tiles, five passes of airlight, the wall, composition.
  CHECK(dispatches({}) == 3 + 9);
  CHECK(dispatches({{"light_depth", "exact"}}) == 2 + 9);
  // T(s,b_i) and lists; distances, T(v,b_i), tiles, airlight, the wall, composition.
  CHECK(dispatches({{"variant", "paper"}}) == 3 + 6);
  const auto lights = scene->lights;
  scene->lights.clear();
  CHECK(dispatches({}) == 4);  // distances, tiles, the depth alone, composition
  CHECK(dispatches({{"variant", "paper"}}) == 4);
  scene->lights.emplace_back(scene::make_constant_environment(Rgb::Ones()));
  CHECK(dispatches({}) == 7);  // and the environment's airlight, the wall, the background
  scene->media.clear();
  CHECK(dispatches({}) == 4);  // distances, the wall and the background in vacuum, composition
  scene->lights = lights;
  CHECK(dispatches({}) == 3);  // the wall in vacuum
  scene->surfaces.push_back({"ball", scene::Sphere{{0, 1, 10}, 1}, scene::Lambert{}});
  finish(*scene);
  CHECK(dispatches({}) == 3);
  scene->surfaces.clear();
  finish(*scene);
  CHECK(dispatches({}) == 0);
}

// Section 5.4. Edge pixels are found by comparing distances. A pixel at the bound may differ in single precision, so
// the 99th percentile of a film of this size allows for a dozen.
DEVICE_TEST_CASE("fogshop: low resolution, GPU agrees with CPU", "[gpu][thorough]") {
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(
      AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/posts.toml", {{"film.width", "27"}, {"film.height", "19"}}));
  auto constant = std::make_shared<scene::Scene>(*scene);
  constant->media[0].field = scene::Homogeneous{0.05};
  auto open = std::make_shared<scene::Scene>(*scene);
  open->surfaces.clear();
  finish(*open);
  for (const std::shared_ptr<const scene::Scene>& each : {scene, {constant}, {open}})
    for (const char* variant : {"S", "paper"})
      for (const char* factor : {"2", "4"})
        for (const char* upsample : {"bilinear", "paper", "recompute"}) {
          Pairs given{{"variant", variant}, {"erf", "erf10"}, {"downsample", factor}, {"upsample", upsample}};
          if (variant == std::string("S")) given["K"] = "8";
          CAPTURE(given, each->media[0].field.index(), each->surfaces.size());
          gpu::test::agree("posts", picture(cpu, each, given), picture(gpu_method, each, given), {2e-6},
                           {"airlight", "transmittance", "mean"});
        }
}

// Media of different albedo: a colour per Gaussian, and one of the constant.
DEVICE_TEST_CASE("fogshop: colours of scattering, GPU agrees with CPU", "[gpu][thorough]") {
  auto scene = std::make_shared<scene::Scene>(*scene_named("f100_constant"));
  scene::Medium other = scene->media[0];
  auto& first = std::get<scene::GaussianSum>(scene->media[0].field);
  auto& second = std::get<scene::GaussianSum>(other.field);
  first.gaussians.resize(40);
  second.gaussians.erase(second.gaussians.begin(), second.gaussians.begin() + 40);
  second.constant = 0;
  scene->media[0].albedo = Rgb(0.9, 0.2, 0.5);
  other.albedo = Rgb(0.1, 0.6, 0.8);
  scene->media.push_back(other);
  for (const Rgb& extinction_ratio : {Rgb(1, 1, 1), Rgb(0.5, 0.8, 1)}) {
    for (auto& medium : scene->media) medium.sigma_t = 0.25 * extinction_ratio;
    for (const Pairs& given : {Pairs{{"variant", "paper"}, {"erf", "erf10"}}, Pairs{{"K", "24"}, {"erf", "erf10"}}})
      agree(scene, given, 2.5e-6, 2.5e-6);
  }
}

// Radii are those of the CPU side, by either rule: what is culled is the same.
DEVICE_TEST_CASE("fogshop: culling, GPU agrees with CPU", "[gpu]") {
  for (const char* name : {"f100", "f100_large", "f100_small"})
    for (const Pairs& cull :
         {Pairs{{"cull", "paper"}}, Pairs{{"eps_T", "1e-2"}}, Pairs{{"eps_T", "1e-2"}, {"variant", "paper"}}}) {
      Pairs given = cull;
      given["erf"] = "erf10";
      agree(scene_named(name), given, 2.5e-6, 2.5e-6);
    }
}

// Section 5.5, the phase beyond a period included.
DEVICE_TEST_CASE("fogshop: noise, GPU agrees with CPU", "[gpu][thorough]") {
  for (const char* name : {"f100", "a30", "tube"})
    for (const char* variant : {"S", "paper"}) {
      const Pairs given{{"variant", variant}, {"erf", "erf10"},         {"noise_scale", "0.4"},
                        {"noise_seed", "3"},  {"noise_phase", "100.3"}, {"noise_frequency", "1.7"}};
      const bool bends = name == std::string("tube") && variant == std::string("S");
      agree(scene_named(name), given, bends ? 3e-5 : 1.1e-5, 1.4e-5);
    }
}

}  // namespace parity_test
