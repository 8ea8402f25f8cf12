// environment_airlight = volume on the device against the CPU: same nodes, same slices, to single precision.
#include <catch2/catch.hpp>

#include "gpu/fogshop/fogshop.h"
#include "gpu/program.h"
#include "methods/fogshop/fogshop.h"
#include "scene/base/error.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/fogshop/small_sky.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"

namespace sky_volume_test {

using namespace airlight;
using gpu::test::quantile;
using Pairs = std::map<std::string, std::string>;
using ScenePointer = std::shared_ptr<scene::Scene>;

namespace {

ScenePointer cloud() {
  auto scene = std::make_shared<scene::Scene>(scene::load_scene(AIRLIGHT_SOURCE_DIR
                                                                "/experiments/scenes/fogshop/environment_cloud.toml",
                                                                {{"film.width", "24"},
                                                                 {"film.height", "18"},
                                                                 {"medium.0.sigma_t", "[0.25, 0.15, 0.05]"},
                                                                 {"medium.0.albedo", "[0.9, 0.8, 0.7]"}}));
  scene->lights[0] = gpu::test::with_small_map(std::get<scene::EnvironmentLight>(scene->lights[0]));
  finish(*scene);
  return scene;
}

scene::Rendering render(const scene::Renderer& renderer, const ScenePointer& scene, Pairs given) {
  given.insert({{"environment_airlight", "volume"}, {"sky_cells", "9"}, {"erf", "erf10"}});
  return airlight::test::render(renderer, scene, given);
}

// Greatest differences of all calls in airlight, transmittance and mean: 99th and 99.9th percentile, and worst.
struct Differences {
  double p99 = 0, p999 = 0, worst = 0;

  double add(const ScenePointer& scene, const Pairs& given) {
    const scene::Film a = render(fogshop::Fogshop(), scene, given).film,
                      b = render(gpu::fogshop::Fogshop(), scene, given).film;
    double here = 0;
    for (const char* layer : {"airlight", "transmittance", "mean"}) {
      here = std::max(here, quantile(a, b, layer, 0.99));
      p999 = std::max(p999, quantile(a, b, layer, 0.999));
      worst = std::max(worst, quantile(a, b, layer, 1));
    }
    CHECK(*std::max_element(a.layer("airlight").begin(), a.layer("airlight").end()) > 0);
    p99 = std::max(p99, here);
    return here;
  }
};

}  // namespace

DEVICE_TEST_CASE("fogshop: sky volume, GPU agrees with CPU", "[gpu][thorough]") {
  const ScenePointer sky = cloud(), both = std::make_shared<scene::Scene>(*sky);
  both->lights.emplace_back(scene::PointLight{Point3(0.5, 1.2, 7), Rgb(300, 200, 100), 0});  // among the Gaussians
  both->surfaces.push_back({"floor", scene::Plane{Point3(0, -1, 0), Vec3::UnitY()}, scene::Lambert{}});
  both->surfaces.push_back({"post", scene::Sphere{Point3(-1, 1, 5), 1.5}, scene::Lambert{}});
  finish(*both);
  Differences d;
  for (const ScenePointer& scene : {sky, both})
    for (const Pairs& given :
         {Pairs{{"sky_cells", "24"}}, Pairs{{"variant", "paper"}, {"K", "8"}},
          Pairs{{"K", "13"}, {"extrapolate", "false"}}, Pairs{{"sky_cells", "5"}, {"sky_directions", "200"}},
          Pairs{{"downsample", "4"}}, Pairs{{"downsample", "2"}, {"upsample", "bilinear"}, {"variant", "paper"}},
          Pairs{{"noise_scale", "0.4"}, {"noise_seed", "3"}, {"noise_frequency", "1.7"}}}) {
      CAPTURE(scene == both, given);
      CHECK(d.add(scene, given) < 6.6e-5);
    }
  CAPTURE(d.p99, d.p999);
  CHECK(d.worst < 1.7e-4);
}

DEVICE_TEST_CASE("fogshop: sky volume under extreme inputs on the device", "[gpu]") {
  const auto scaled = [](double factor) {
    const ScenePointer scene = cloud();
    for (auto& g : std::get<scene::GaussianSum>(scene->media[0].field).gaussians) g.amplitude *= factor;
    finish(*scene);
    return scene;
  };
  for (const char* variant : {"S", "paper"}) {
    CAPTURE(variant);
    const Pairs given{{"variant", variant}};
    for (const double factor : {1e-6, 1e3}) {
      Differences d;
      CAPTURE(factor);
      CHECK(d.add(scaled(factor), given) < 7.4e-5);
    }
    // From 10 km: the cloud is 8 pixels high.
    const ScenePointer far = cloud();
    far->camera = scene::look_at(Point3(0, 1, -1e4), Point3(0, 1, 8), Vec3::UnitY());
    far->camera.vertical_fov = 2e-3;
    Differences d;
    CHECK(d.add(far, given) < 4.6e-4);  // places along a ray are good to 1e-3 m there
    // One Gaussian, as wide as it gets from within.
    const ScenePointer one = cloud();
    std::get<scene::GaussianSum>(one->media[0].field).gaussians = {{Point3(0, 1, -8), 2, 1}};
    finish(*one);
    Differences e;
    CHECK(e.add(one, given) < 6.7e-5);
  }
}

// More beams than a dispatch may loop over are done by several; what no device can hold is refused.
DEVICE_TEST_CASE("fogshop: sky volume by many beams on the device", "[gpu]") {
  const ScenePointer scene = cloud();
  const Pairs many{{"sky_cells", "3"}, {"sky_directions", "3000"}};  // 102 * 3000 iterations
  const long before = gpu::Program::dispatches();
  const scene::Film b = render(gpu::fogshop::Fogshop(), scene, many).film;
  CHECK(gpu::Program::dispatches() - before ==
        6 + 5);  // tiles, reach, the environment's by two passes, background, composition; nodes
  CHECK(quantile(render(fogshop::Fogshop(), scene, many).film, b, "airlight", 1) < 3.5e-6);
  std::get<scene::GaussianSum>(scene->media[0].field).gaussians.resize(1);  // a cube
  finish(*scene);
  if (context.limits().storage_block < std::size_t(257) * 257 * 257 * 12)
    CHECK_THROWS_AS(render(gpu::fogshop::Fogshop(), scene, {{"sky_cells", "256"}}), Unavailable);
}

DEVICE_TEST_CASE("fogshop: a sky volume that nothing needs costs no dispatch", "[gpu]") {
  const auto dispatches = [](const ScenePointer& scene) {
    const long before = gpu::Program::dispatches();
    render(gpu::fogshop::Fogshop(), scene, {});
    return gpu::Program::dispatches() - before;
  };
  const ScenePointer scene = cloud();
  CHECK(dispatches(scene) == 7);  // the nodes, tiles, reach, the environment's by two, background, composition
  const gpu::fogshop::Fogshop method;
  const Pairs given{{"environment_airlight", "volume"}};
  const auto prepared = method.prepare(scene, {method.settings(), given}, {1, {}});
  const auto has = [](const std::vector<scene::StageTime>& times, const std::string& name) {
    return std::any_of(times.begin(), times.end(), [&](const auto& time) { return time.name == name; });
  };
  CHECK(has(prepared->prepare_times(), "sky volume"));
  CHECK_FALSE(has(prepared->prepare_times(), "harmonics of the environment"));
  CHECK(has(prepared->render(view_of(*scene), {1, {}}).times, "environment"));
  const auto lights = scene->lights;
  scene->lights.clear();
  CHECK(dispatches(scene) == 3);  // the depth alone
  scene->lights = lights;
  std::get<scene::GaussianSum>(scene->media[0].field).gaussians.clear();
  finish(*scene);
  CHECK(dispatches(scene) == 2);  // no medium: background, composition
  std::get<scene::GaussianSum>(scene->media[0].field).constant = 0.1;
  finish(*scene);
  CHECK_THROWS_AS(dispatches(scene), Error);
}

}  // namespace sky_volume_test
