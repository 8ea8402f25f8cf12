// Variant VS2 on the device against the CPU: the same integrals, moments and nodes, to single precision.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "gpu/fogshop/fogshop_gpu.h"
#include "gpu/fogshop/passes.h"
#include "gpu/program.h"
#include "methods/fogshop/fogshop.h"
#include "scene/error.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/methods/fogshop/ray_model.h"

using namespace airlight;
using gpu::test::quantile;
using Pairs = std::map<std::string, std::string>;

namespace {

scene::Film render(const scene::Renderer& renderer, const std::shared_ptr<const scene::Scene>& scene, Pairs given) {
  given.insert({{"variant", "VS2"}, {"erf", "erf10"}});
  return renderer.prepare(scene, {renderer.settings(), given}, {1, {}})->render(view_of(*scene), {1, {}}).film;
}

std::shared_ptr<scene::Scene> scene_named(const std::string& name) {
  return std::make_shared<scene::Scene>(
      scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/" + name + ".toml",
                        {{"film.width", "24"}, {"film.height", "18"}}));
}

}  // namespace

TEST_CASE("fogshop: VS2, GPU agrees with CPU", "[gpu]") {
  if (!gpu::test::device()) return;
  auto coloured = scene_named("f100_constant");
  scene::Medium other = coloured->media[0];
  auto& first = std::get<scene::GaussianSum>(coloured->media[0].field);
  auto& second = std::get<scene::GaussianSum>(other.field);
  first.gaussians.resize(40);
  second.gaussians.erase(second.gaussians.begin(), second.gaussians.begin() + 40);
  second.constant = 0;
  coloured->media[0].albedo = Rgb(0.9, 0.2, 0.5);
  other.albedo = Rgb(0.1, 0.6, 0.8);
  coloured->media.push_back(other);
  for (auto& medium : coloured->media) medium.sigma_t = 0.25 * Rgb(0.5, 0.8, 1);
  double p99 = 0, p999 = 0, worst = 0;
  const auto compare = [&](const std::shared_ptr<const scene::Scene>& scene, const Pairs& given) {
    const scene::Film a = render(fogshop::Fogshop(), scene, given), b = render(gpu::FogshopGpu(), scene, given);
    CAPTURE(scene->name, scene == coloured, given);
    CHECK(*std::max_element(a.layer("airlight").begin(), a.layer("airlight").end()) > 0);
    for (const char* layer : {"airlight", "transmittance", "mean"}) {
      CHECK(quantile(a, b, layer, 0.99) < 2e-4);
      p99 = std::max(p99, quantile(a, b, layer, 0.99));
      p999 = std::max(p999, quantile(a, b, layer, 0.999));
      worst = std::max(worst, quantile(a, b, layer, 1));
    }
  };
  for (const char* name : {"f100_thin", "f100", "f100_constant", "a30", "a100", "halo_far", "halo_near", "d100_thick",
                           "tube", "lights_4", "count_967"})
    compare(scene_named(name), {});
  for (const char* name : {"a30", "f100_constant"})
    for (const Pairs& given :
         {Pairs{{"light_depth", "exact"}}, Pairs{{"K", "13"}, {"extrapolate", "false"}, {"edges", "plain"}},
          Pairs{{"K", "1"}, {"extrapolate", "false"}}, Pairs{{"downsample", "2"}}, Pairs{{"source_radius", "0.3"}},
          Pairs{{"noise_scale", "0.4"}, {"noise_seed", "3"}, {"noise_frequency", "1.7"}}})
      compare(scene_named(name), given);
  compare(coloured, {});
  CAPTURE(p99, p999);
  CHECK(worst < 1e-3);
}

// One Gaussian, everywhere: behind, around and up to 1e4 widths before the viewer, depths from 1e-6 to 1e3, the light
// from next to the ray to far away. What is left at the end are depths of hundreds whose places are good to 1e-3
// widths.
TEST_CASE("fogshop: VS2 of one Gaussian in many places on the device", "[gpu]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  std::mt19937 random(5);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto log_between = [&](double a, double b) { return std::pow(10, between(a, b)); };
  std::vector<double> errors;
  for (int i = 0; i < 1000; ++i) {
    const double width = float(log_between(-2, 2)), depth = log_between(-6, 3);
    const double along = i % 4 == 0 ? log_between(0, 4) : between(-2, 6);  // [widths]
    const Point3 center(float(width * between(-1.5, 1.5)), 0, float(width * along));
    const double angle = between(0, 2 * pi), h = width * log_between(-4, i % 3 == 0 ? 4 : 1);
    const Point3 light(float(h * std::cos(angle)), float(h * std::sin(angle)),
                       float(width * (along + (i % 3 == 0 ? 100 : 3) * between(-1, 1))));
    const double length = i % 5 == 0 ? infinity : double(float(width * (along + between(-1, 6))));
    if (!(length > 0)) continue;
    const fogshop::Fog fog = fogshop_test::grey_fog({{{center, width, depth / (width * std::sqrt(pi))}}, 0, infinity});
    fogshop::Options options = fogshop_test::exact(fogshop::Options::Variant::voigt, 24);
    options.erf = fogshop::Erf::erf10;
    const double expected =
        fogshop_test::ray_airlight(options, fog, light, Rgb::Ones(), {Point3::Zero(), Vec3::UnitZ(), length})[0];
    fogshop::Model model;
    model.options = options;
    model.fog = fog;
    model.gaussians = make_arrays(fog.sum.gaussians, options.cull, options.depth_threshold).arrays;
    model.lights.push_back({light, Rgb::Ones(), {}, nullptr});
    gpu::FogOnDevice device(*context, model);
    gpu::StageTimer timer(*context);
    const scene::View one{scene::look_at(Point3::Zero(), Vec3::UnitZ(), Vec3::UnitY()), 1, 1};
    const gpu::Buffer distance(*context, "distances",
                               std::vector<float>{length < gpu::far_away ? float(length) : gpu::far_away});
    const double got = device.airlight(one, &distance, timer)->download<float>().at(0);
    errors.push_back(std::abs(got - expected) / (expected + 1e-30));
  }
  std::sort(errors.begin(), errors.end());
  const std::size_t n = errors.size();
  CAPTURE(errors[n * 999 / 1000]);
  CHECK(errors[n / 2] < 1e-6);
  CHECK(errors[n * 99 / 100] < 2e-3);
  CHECK(errors[n - 1] < 3e-2);
}

TEST_CASE("fogshop: VS2 dispatches what S does, and refuses loops that would be cut short", "[gpu]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  const auto dispatches = [](const std::shared_ptr<const scene::Scene>& scene, const Pairs& given) {
    const long before = gpu::Program::dispatches();
    render(gpu::FogshopGpu(), scene, given);
    return gpu::Program::dispatches() - before;
  };
  auto scene = scene_named("f100");
  CHECK(dispatches(scene, {}) == dispatches(scene, {{"variant", "S"}}));
  scene->lights.clear();
  CHECK(dispatches(scene, {}) == 3);  // the depth alone
  std::get<scene::GaussianSum>(scene->media[0].field).gaussians.clear();
  finish(*scene);
  CHECK(dispatches(scene, {}) == 0);
  if (context->software())
    CHECK_THROWS_AS(dispatches(scene_named("count_967"), {{"light_depth", "exact"}}), Unavailable);
}
