// Fogshop on the GPU against Fogshop on the CPU: same variant, same settings, same picture to single precision.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/fogshop/fogshop_gpu.h"
#include "gpu/program.h"
#include "gpu/raster_program.h"
#include "methods/fogshop/fogshop.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"

using namespace airlight;
using Pairs = std::map<std::string, std::string>;

namespace {

scene::Film render(const scene::Renderer& renderer, const std::shared_ptr<const scene::Scene>& scene,
                   const Pairs& given) {
  const auto prepared = renderer.prepare(scene, {renderer.settings(), given}, {1, {}});
  return prepared->render(view_of(*scene), {1, {}}).film;
}

// 99th percentile of |b - a| / (a + 1 % of the greatest a); infinite if anything is not finite.
double p99(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  const std::vector<float>&x = a.layer(layer), &y = b.layer(layer);
  const double most = *std::max_element(x.begin(), x.end());
  std::vector<double> errors;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) return infinity;
    errors.push_back(std::abs(double(y[i]) - x[i]) / (x[i] + 0.01 * most + 1e-300));
  }
  std::sort(errors.begin(), errors.end());
  return errors[std::size_t(0.99 * double(errors.size() - 1))];
}

std::shared_ptr<const scene::Scene> scene_named(const std::string& name) {
  return std::make_shared<const scene::Scene>(
      scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/" + name + ".toml",
                        {{"film.width", "24"}, {"film.height", "18"}}));
}

}  // namespace

TEST_CASE("fogshop: GPU agrees with CPU", "[gpu]") {
  if (!gpu::test::device()) return;
  const fogshop::Fogshop cpu;
  const gpu::FogshopGpu gpu;
  double worst = 0;
  for (const char* name : {"f100_thin", "f100", "f100_constant", "a30", "a100", "halo_far", "halo_near", "d100_thick",
                           "tube", "count_251"}) {
    const auto scene = scene_named(name);
    for (Pairs given : {Pairs{{"variant", "paper"}}, Pairs{{"K", "24"}}, Pairs{{"K", "12"}, {"extrapolate", "false"}},
                        Pairs{{"K", "13"}, {"extrapolate", "false"}, {"edges", "plain"}}}) {
      given["erf"] = "erf10";  // the same approximation on both sides
      const scene::Film a = render(cpu, scene, given), b = render(gpu, scene, given);
      CAPTURE(name, given);
      const double error = p99(a, b, "airlight");
      worst = std::max(worst, error);
      CHECK(error < 2e-3);
      CHECK(p99(a, b, "transmittance") < 2e-3);
    }
  }
  INFO("worst 99th percentile: " << worst);
  CHECK(worst < 2e-3);
}

TEST_CASE("fogshop: what a scene has not costs no dispatch", "[gpu]") {
  if (!gpu::test::device()) return;
  const gpu::FogshopGpu method;
  auto scene = std::make_shared<scene::Scene>(*scene_named("f100"));
  const auto dispatches = [&](const Pairs& given) {
    const long before = gpu::Program::dispatches();
    render(method, scene, given);
    return gpu::Program::dispatches() - before;
  };
  const auto draws = [&] {
    const long before = gpu::RasterProgram::draws();
    render(method, scene, {});
    return gpu::RasterProgram::draws() - before;
  };
  CHECK(dispatches({}) == 5);  // one light map, tiles, airlight, the wall, composition
  CHECK(dispatches({{"light_depth", "exact"}}) == 4);
  CHECK(dispatches({{"variant", "paper"}}) == 6);  // T(s,b_i), T(v,b_i), tiles, airlight, the wall, composition
  CHECK(draws() == 1);                             // the wall, which has nothing to cast a shadow on
  const auto lights = scene->lights;
  scene->lights.clear();
  CHECK(dispatches({}) == 3);  // the depth alone, composition
  CHECK(dispatches({{"variant", "paper"}}) == 3);
  scene->media.clear();
  CHECK(dispatches({}) == 0);
  scene->lights = lights;
  CHECK(dispatches({}) == 2);  // the wall in vacuum
  scene->surfaces.push_back({"ball", scene::Sphere{{0, 1, 10}, 1}, scene::Lambert{}});
  finish(*scene);
  CHECK(draws() == 7);  // the view, and six faces around the light
  scene->surfaces.clear();
  finish(*scene);
  CHECK(draws() == 0);
  CHECK(dispatches({}) == 0);
}
