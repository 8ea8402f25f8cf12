// homogeneous = table on the device against the CPU: the same table, the same lines between its entries.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "gpu/fogshop/fog.h"
#include "gpu/fogshop/fogshop.h"
#include "gpu/program.h"
#include "methods/fogshop/fogshop.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"

namespace f_table_test {

using namespace airlight;
using gpu::test::quantile;
using Pairs = std::map<std::string, std::string>;

namespace {

scene::Film render(const scene::Renderer& renderer, const std::shared_ptr<const scene::Scene>& scene, Pairs given) {
  given.insert({{"variant", "paper"}, {"homogeneous", "table"}, {"erf", "erf10"}});
  return airlight::test::picture(renderer, scene, given);
}

std::shared_ptr<scene::Scene> scene_named(const std::string& name) {
  return airlight::test::scene_named("fogshop/" + name, 24, 18);
}

// Airlight on the device for a constant medium of extinction `beta`, a light of 1 W/sr, and one ray along +z.
double on_device(gpu::Context& context, const fogshop::FTable& table, const fogshop::LightFromRay& light, double d_vp,
                 double beta) {
  fogshop::Model model;
  model.options.variant = fogshop::Options::Variant::paper;
  model.fog.sum.constant = beta;
  model.lights.push_back({Point3(light.h, 0, light.along), Rgb::Ones(), {}, nullptr});
  fogshop::Needs needs{};
  needs.airlight = needs.f_table = true;
  model.f_table = std::make_unique<fogshop::FTable>(table);
  gpu::fogshop::FogOnDevice device(context, model, needs);
  gpu::Frame frame(context);
  frame.begin({});
  const scene::View one{scene::look_at(Point3::Zero(), Vec3::UnitZ(), Vec3::UnitY()), 1, 1};
  const gpu::Buffer distance(context, "distances",
                             std::vector<float>{d_vp < gpu::far_away ? float(d_vp) : gpu::far_away});
  return device.airlight(one, &distance, frame).download<float>().at(0);
}

}  // namespace

DEVICE_TEST_CASE("fogshop: table of F, GPU agrees with CPU", "[gpu]") {
  auto coloured = scene_named("f100_constant");
  coloured->media[0].sigma_t = 0.25 * Rgb(0.5, 0.8, 1);
  auto alone = std::make_shared<scene::Scene>(*coloured);
  alone->media[0].field = scene::Homogeneous{0.3};
  finish(*alone);
  double p99 = 0, p999 = 0, worst = 0;
  for (const auto& scene : {scene_named("f100_constant"), scene_named("tube"), scene_named("a30"), coloured, alone})
    for (const Pairs& given : {Pairs{}, Pairs{{"downsample", "2"}}}) {
      const scene::Film a = render(fogshop::Fogshop(), scene, given), b = render(gpu::fogshop::Fogshop(), scene, given);
      CAPTURE(scene->name, scene == alone, given);
      CHECK(*std::max_element(a.layer("airlight").begin(), a.layer("airlight").end()) > 0);
      for (const char* layer : {"airlight", "mean"}) {
        CHECK(quantile(a, b, layer, 0.99) < 1e-5);
        p99 = std::max(p99, quantile(a, b, layer, 0.99));
        p999 = std::max(p999, quantile(a, b, layer, 0.999));
        worst = std::max(worst, quantile(a, b, layer, 1));
      }
    }
  CAPTURE(p99, p999);
  CHECK(worst < 1.5e-5);
}

// Lights before, beside and behind the ray's start, from thin to thick. Far behind in thick fog the printed form is e^T
// times a difference of two numbers near their limit: noise in double precision as well.
DEVICE_TEST_CASE("fogshop: table of F under many geometries on the device", "[gpu]") {
  const fogshop::FTable table;
  std::mt19937 random(7);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::vector<double> errors;
  for (int i = 0; i < 2000; ++i) {
    const double d_sv = std::pow(10, between(-2, 4));
    const double small = std::pow(10, between(-4, 0));
    const double gamma = i % 3 == 0 ? small : i % 3 == 1 ? pi - small : between(0, pi);
    const double beta = float(std::pow(10, between(-6, gamma < pi / 2 ? 3 : 1)) / d_sv);
    const double d_vp = i % 5 == 0 ? infinity : double(float(d_sv * std::pow(10, between(-3, 2))));
    const fogshop::LightFromRay light{float(d_sv * std::cos(gamma)), float(d_sv * std::sin(gamma))};
    const double expected = table.homogeneous_airlight(light, d_vp, beta);
    const double got = on_device(context, table, light, d_vp, beta);
    errors.push_back(std::abs(got - expected) / (expected + 1e-30));
  }
  std::sort(errors.begin(), errors.end());
  CAPTURE(errors[1000], errors[1998]);
  CHECK(errors[1980] < 4e-5);
  CHECK(errors[1999] < 1.5e-4);
}

DEVICE_TEST_CASE("fogshop: a table of F that nothing reads is not made", "[gpu]") {
  const gpu::fogshop::Fogshop method;
  const auto made = [&](const std::shared_ptr<const scene::Scene>& scene, Pairs given) {
    given["homogeneous"] = "table";
    const auto times = method.prepare(scene, {method.settings(), given}, {1, {}})->prepare_times();
    return std::any_of(times.begin(), times.end(), [](const auto& time) { return time.name == "table of F"; });
  };
  const auto dispatches = [&](const std::string& homogeneous) {
    const long before = gpu::Program::dispatches();
    render(method, scene_named("f100_constant"), {{"homogeneous", homogeneous}});
    return gpu::Program::dispatches() - before;
  };
  auto scene = scene_named("f100_constant");
  CHECK(made(scene, {{"variant", "paper"}}));
  CHECK_THROWS_WITH(made(scene, {{"variant", "S"}}), Catch::Contains("is not read with variant = S"));
  CHECK_FALSE(made(scene_named("f100"), {{"variant", "paper"}}));
  scene->lights.clear();
  CHECK_FALSE(made(scene, {{"variant", "paper"}}));
  CHECK(dispatches("table") == dispatches("exact"));
}

}  // namespace f_table_test
