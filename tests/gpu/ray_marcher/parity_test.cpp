// The ray marcher on the GPU against the ray marcher on the CPU: same settings, same steps, same picture to single
// precision; and against the truth by itself.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/program.h"
#include "reference/deterministic/airlight.h"
#include "scene/base/error.h"
#include "tests/gpu/ray_marcher/pictures.h"

namespace parity_test {

using namespace airlight;
using gpu::test::p99;
using namespace airlight::ray_marcher;

namespace {

// Every medium, region, phase function, kind of light and surface of the CPU's own tests.
void agree(const std::vector<Given>& all) {
  if (!gpu::test::device()) return;
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name == "overlap of all") continue;  // comes again with surfaces, and every program costs seconds to compile
    const scene::View view = look();
    for (Given given : all) {
      if (given.count("step") && scene->geometry) continue;  // seconds
      given.insert({{"steps", "64"}, {"shadow_steps", "12"}, {"environment_directions", "8"}});
      given = scene::without_unread(option_specs(), given);
      const scene::Rendering cpu = render(scene, view, given, 1), gpu = render_gpu(scene, view, given);
      CAPTURE(name, given["spacing"], given["step"]);
      gpu::test::agree(name, cpu.film, gpu.film, {7e-6},
                       {"airlight", "transmittance", "surface"});  // measured: 2.5e-6 at worst
      // The steps are equal, except for rounding on rays along a cut.
      for (const char* counter : {"rays", "steps", "shadow_rays", "occlusion_rays"}) {
        if (given.count("early_exit") && counter == std::string("steps")) continue;  // the CPU samples, then leaves out
        CAPTURE(counter);
        CHECK(gpu.counters.at(counter) == Approx(cpu.counters.at(counter)).epsilon(2e-3));
      }
      // Where the CPU skips, it does so for all lanes of a vector together.
      if (given.count("empty_space_skipping"))
        CHECK(gpu.counters.at("shadow_steps") == Approx(cpu.counters.at("shadow_steps")).epsilon(2e-3));
      else
        CHECK(gpu.counters.at("shadow_steps") <= cpu.counters.at("shadow_steps") * 1.002);
    }
  }
}

}  // namespace

TEST_CASE("ray marcher: GPU agrees with CPU", "[gpu][ray_marcher]") {
  agree({{{"step", "0.31"}, {"shadow_step", "0.23"}, {"early_exit", "0.05"}}, {}});
}

TEST_CASE("ray marcher: GPU agrees with CPU in steps of one length, without skipping", "[gpu][ray_marcher][thorough]") {
  agree({{{"spacing", "uniform"}, {"steps", "40"}, {"empty_space_skipping", "false"}}});
}

// Triangles, which the scenes above have not.
DEVICE_TEST_CASE("ray marcher: meshes cast shadows on the GPU", "[gpu][ray_marcher]") {
  const auto scene = std::make_shared<const scene::Scene>(
      scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/crosscheck/mesh_in_fog.toml"));
  scene::View view = view_of(*scene);
  view.width = 24, view.height = 18;
  const Given given{{"steps", "24"}, {"environment_directions", "4"}};
  const scene::Rendering cpu = render(scene, view, given, 1), gpu = render_gpu(scene, view, given);
  CHECK(p99(cpu.film, gpu.film, "airlight") < 2.5e-5);  // a step at a shadow's edge may fall to the other side
  CHECK(gpu.counters.at("occlusion_rays") == cpu.counters.at("occlusion_rays"));
  CHECK(gpu.counters.at("shadow_rays") == Approx(cpu.counters.at("shadow_rays")).epsilon(2e-3));
  CHECK(gpu.counters.at("shadow_rays") < 0.999 * gpu.counters.at("occlusion_rays"));  // some are hidden
}

// Meshes, a sphere, a plane, a light's ball: every pixel, at silhouettes and edges of shadows too.
DEVICE_TEST_CASE("ray marcher: surfaces on the GPU are those of the CPU", "[gpu][ray_marcher]") {
  for (const char* file : {"crosscheck/mesh_in_fog", "crosscheck/surfaces_in_fog", "elephant_fog"}) {
    auto changed = scene::load_scene(fmt::format(AIRLIGHT_SOURCE_DIR "/experiments/scenes/{}.toml", file));
    for (scene::Light& light : changed.lights)
      if (auto* point = std::get_if<scene::PointLight>(&light)) point->radius = 0.05;
    const auto scene = std::make_shared<const scene::Scene>(changed);
    scene::View view = view_of(*scene);
    view.width = 96, view.height = 72;
    const Given given{{"steps", "4"}, {"shadow_steps", "2"}, {"environment_directions", "4"}};
    const scene::Rendering cpu = render(scene, view, given, 1), gpu = render_gpu(scene, view, given);
    CHECK(std::any_of(gpu.times.begin(), gpu.times.end(), [](const auto& t) { return t.name == "distances"; }));
    CAPTURE(file);
    gpu::test::agree(file, cpu.film, gpu.film, {4e-6, 3e-6}, {"surface", "transmittance"});
    gpu::test::agree(file, cpu.film, gpu.film, {4e-6, 1.8e-4}, {"mean"});
    for (const char* counter : {"occlusion_rays", "shadow_rays"})
      CHECK(gpu.counters.at(counter) == Approx(cpu.counters.at(counter)).epsilon(1e-4));
    // By the rasteriser, too, but for silhouettes.
    Given raster = given;
    raster["first_hits"] = "raster";
    const scene::Rendering other = render_gpu(scene, view, raster);
    CHECK(other.counters.at("draws") > 0);
    CHECK(gpu.counters.at("draws") == 0);
    CHECK(p99(cpu.film, other.film, "mean") < 4e-6);
  }
}

// Rays go on beyond a lamp that lies deeper than the horizon.
DEVICE_TEST_CASE("ray marcher: a lamp deep in endless fog on the GPU", "[gpu][ray_marcher]") {
  for (const double depth : {10.0, 30.0, 50.0}) {
    const auto scene = make_scene(
        {make_medium(scene::Homogeneous{1}, scene::Unbounded{}, Rgb(0.9, 1, 0.95) * depth / 4, Rgb::Constant(0.9))},
        {scene::PointLight{Point3(0, 0, 4), Rgb::Ones(), 0}});
    scene->camera = scene::look_at(Point3::Zero(), Point3(1, 0, 1), Vec3::UnitY());
    scene::View view = view_of(*scene);
    view.width = 8, view.height = 6;
    for (const char* spacing : {"graded", "uniform"}) {
      CAPTURE(depth, spacing);
      const Given given{{"spacing", spacing}};
      CHECK(p99(render(scene, view, given, 1).film, render_gpu(scene, view, given).film, "airlight") < 1.6e-5);
    }
  }
}

// As many as the CPU takes.
DEVICE_TEST_CASE("ray marcher: 32 media on the GPU", "[gpu][ray_marcher]") {
  const auto scene = scene_of_media(32);
  const Given given{{"steps", "64"}, {"shadow_steps", "12"}};
  const scene::Rendering cpu = render(scene, look(), given, 1), gpu = render_gpu(scene, look(), given);
  gpu::test::agree("32 media", cpu.film, gpu.film, {7e-6}, {"airlight", "transmittance"});
  for (const char* counter : {"rays", "steps", "shadow_rays"})
    CHECK(gpu.counters.at(counter) == Approx(cpu.counters.at(counter)).epsilon(2e-3));
}

DEVICE_TEST_CASE("ray marcher: exact shadows of Gaussians and grids on the GPU", "[gpu][ray_marcher]") {
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name.find("Gaussians") == std::string::npos && name.find("grid") == std::string::npos) continue;
    CAPTURE(name);
    const Given given{{"shadow", "exact"}};
    const scene::Rendering cpu = render(scene, look(), given, 1), gpu = render_gpu(scene, look(), given);
    // Measured for grids: 3.4e-6. The CPU integrates in double precision.
    CHECK(p99(cpu.film, gpu.film, "airlight") < (name == "Gaussians" ? 1.7e-6 : 7e-6));
    CHECK(gpu.counters.at("shadow_steps") == 0);
  }
}

DEVICE_TEST_CASE("ray marcher: exact shadows of negative Gaussians on the GPU", "[gpu][ray_marcher]") {
  const auto agree = [](const std::string& name, const scene::GaussianSum& sum, const Point3& light) {
    const auto scene = make_scene({make_medium(sum, Box{{-2, -2, -2}, {2, 2, 2}}, Rgb(1.5, 2, 3), Rgb::Constant(0.9))},
                                  {scene::PointLight{{light}, Rgb(5, 4, 3)}});
    const Given given{{"steps", "24"}, {"shadow", "exact"}};
    const scene::Rendering cpu = render(scene, look(), given, 1), gpu = render_gpu(scene, look(), given);
    gpu::test::agree(name, cpu.film, gpu.film, {7e-6, 7e-6}, {"airlight"});
  };
  // Many holes, which meet and leave thin bridges. Widths differ by a factor of ten.
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double constant : {0.0, 0.05}) {
    scene::GaussianSum sum{{}, constant, infinity};
    for (int i = 0; i < 24; ++i)
      sum.gaussians.push_back({Point3(2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1),
                               0.1 * std::pow(10, uniform(random)), i % 2 ? 0.5 + uniform(random) : -uniform(random)});
    agree("holes", sum, {1.5, 2, 1});
  }
  // A sheet that takes just more than there is: the gap is thinner than the distance of the places that rays look at.
  scene::GaussianSum sheet{{}, 1, infinity};
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) sheet.gaussians.push_back({Point3(0, 0.3 * i, 0.3 * j), 0.3, -1.003 / pi});
  agree("a thin gap", sheet, {0.5, 0, 0});
}

DEVICE_TEST_CASE("ray marcher: grids in textures are the grids in a buffer", "[gpu][ray_marcher][thorough]") {
  // Two of them, of different sizes, one turned.
  const Mat3 turned = Eigen::AngleAxisd(0.4, Vec3(1, 2, 2) / 3).toRotationMatrix();
  const auto medium = [](std::shared_ptr<const scene::VoxelGrid> grid, const Rgb& sigma_t) {
    return make_medium(grid, scene::Unbounded{}, sigma_t, Rgb::Constant(0.8), scene::HenyeyGreenstein{0.3});
  };
  const auto scene =
      make_scene({medium(make_smoke(12, 0.15, Vec3(-1, -1, -1), turned), Rgb(2, 3, 4)),
                  medium(make_smoke(7, 0.2, Vec3(-0.2, -0.6, -0.7), Mat3::Identity(), true), Rgb(1, 1, 2))},
                 {scene::PointLight{{Point3(1.5, 2, 1)}, Rgb(5, 4, 3)}});
  const Given steps{{"steps", "24"}, {"shadow_steps", "12"}};
  Given texture = steps, buffer = steps;
  texture["grid_storage"] = "texture", buffer["grid_storage"] = "buffer";
  const scene::Rendering cpu = render(scene, look(), steps, 1), a = render_gpu(scene, look(), texture),
                         b = render_gpu(scene, look(), buffer);
  for (const char* layer : {"airlight", "transmittance"}) {
    CHECK(p99(cpu.film, a.film, layer) < 2.6e-6);
    CHECK(p99(b.film, a.film, layer) < 1e-6);  // llvmpipe: the same bits
  }
  CHECK(a.counters.at("shadow_steps") == b.counters.at("shadow_steps"));
}

// More than a storage buffer of llvmpipe holds: automatic storage changes over, and a buffer is refused in one line.
DEVICE_TEST_CASE("ray marcher: a grid beyond the limit of storage buffers", "[gpu][ray_marcher][thorough]") {
  if (context.limits().storage_block > std::size_t(128) << 20) {
    WARN("test skipped: storage buffers of this device are larger");
    return;
  }
  auto grid = std::make_shared<scene::VoxelGrid>();
  const int side = 322;  // with its padding 326^3 values, 132 MiB
  grid->size.setConstant(side);
  grid->voxel_size = 2.0 / side;
  grid->translation = Vec3::Constant(-1);
  grid->values.resize(std::size_t(side) * side * side);
  for (int k = 0; k < side; ++k)  // two ramps, the second one partly behind the limit
    std::fill_n(grid->values.begin() + std::size_t(k) * side * side, std::size_t(side) * side, float(k % 160) / 160);
  const auto scene = make_scene({make_medium(std::shared_ptr<const scene::VoxelGrid>(grid), scene::Unbounded{},
                                             Rgb(2, 3, 4), Rgb::Constant(0.8))},
                                {scene::PointLight{{Point3(1.5, 2, 1)}, Rgb(5, 4, 3)}});
  const Given steps{{"steps", "16"}, {"shadow_steps", "8"}};
  const scene::Rendering cpu = render(scene, look(), steps, 1), gpu = render_gpu(scene, look(), steps);
  CHECK(p99(cpu.film, gpu.film, "airlight") < 4.5e-5);
  Given buffer = steps;
  buffer["grid_storage"] = "buffer";
  CHECK_THROWS_MATCHES(render_gpu(scene, look(), buffer), Unavailable,
                       Catch::Predicate<Unavailable>(
                           [](const Unavailable& e) {
                             return std::string(e.what()).find("buffer 'voxel grids' needs 132.2 MiB") !=
                                    std::string::npos;
                           },
                           "names the buffer and its size"));
}

// Order 2, towards the closed reference and not towards the CPU's marcher.
DEVICE_TEST_CASE("ray marcher: the GPU reaches the deterministic truth at order 2", "[gpu][ray_marcher]") {
  const scene::View view = look();
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name != "Gaussians") continue;
    const deterministic::AirlightIntegrator truth(*scene, {1e-9, 2000000});
    std::vector<double> exact;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const auto result = truth(camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height), infinity);
        REQUIRE(result.converged);
        for (int c = 0; c < 3; ++c) exact.push_back(result.radiance[c]);
      }
    std::vector<double> errors;
    for (const char* steps : {"32", "64", "128"}) {
      const auto airlight = render_gpu(scene, view, {{"steps", steps}, {"shadow_steps", steps}}).film.layer("airlight");
      double difference = 0, scale = 0;
      for (std::size_t i = 0; i < exact.size(); ++i) {
        difference += (airlight[i] - exact[i]) * (airlight[i] - exact[i]);
        scale += exact[i] * exact[i];
      }
      errors.push_back(std::sqrt(difference / scale));
    }
    CAPTURE(errors);
    CHECK(std::log2(errors[0] / errors[2]) / 2 == Approx(2).margin(0.25));
    CHECK(errors[2] < 1e-3);
  }
}

DEVICE_TEST_CASE("ray marcher: the GPU takes no step in empty space, nor makes a dispatch without a medium",
                 "[gpu][ray_marcher]") {
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name == "nothing") {
      const long before = gpu::Program::dispatches();
      const scene::Rendering empty = render_gpu(scene, look(), {});
      CHECK(gpu::Program::dispatches() == before);
      CHECK(empty.counters.at("dispatches") == 0);
      for (const float t : empty.film.layer("transmittance")) CHECK(t == 1);
    }
    if (name != "grid") continue;
    const Given all{{"empty_space_skipping", "false"}};
    const scene::Rendering cpu = render(scene, look(), {}, 1), gpu = render_gpu(scene, look(), {}),
                           whole = render_gpu(scene, look(), all);
    CHECK(gpu.counters.at("steps") == Approx(cpu.counters.at("steps")).epsilon(1e-3));
    CHECK(gpu.counters.at("steps") < 0.7 * whole.counters.at("steps"));
    CHECK(p99(gpu.film, whole.film, "airlight") < 1e-6);
    // Nothing scatters: no shadow ray.
    auto black = std::make_shared<scene::Scene>(*scene);
    black->media[0].albedo = Rgb::Zero();
    CHECK(render_gpu(black, look(), {}).counters.at("shadow_rays") == 0);
  }
}

TEST_CASE("ray marcher: what the GPU does not do is said; a render can be stopped", "[gpu][ray_marcher]") {
  const gpu::ray_marcher::RayMarcher marcher;
  const auto objections = [&](const std::string& wanted, const Given& given) {
    for (const auto& [name, scene] : assorted_scenes())
      if (name == wanted) return marcher.supports(*scene, {marcher.settings(), given}).size();
    return std::size_t(99);
  };
  CHECK(objections("grid", {}) == 0);
  CHECK(objections("grid", {{"shadow", "exact"}}) == 0);
  CHECK(objections("Gaussians", {{"shadow", "exact"}}) == 0);
  CHECK(objections("Gaussians with a hole, cut off, over a constant, in a sphere", {{"shadow", "exact"}}) == 0);
  CHECK(objections("Gaussians", {{"kernel", "scalar"}}) == 1);
  CHECK(objections("Gaussians", {{"shadow", "map"}}) == 0);
  if (!gpu::test::device()) return;
  for (const auto& [name, scene] : assorted_scenes())
    if (name == "Gaussians") {
      const auto prepared = marcher.prepare(scene, {marcher.settings(), {}}, {1, {}});
      CHECK_THROWS_AS(prepared->render(look(), {1, [](double) { return false; }}), scene::Interrupted);
    }
}

// Steps follow the optical depth as the CPU's do, as far as single precision knows places; beyond, it says so.
DEVICE_TEST_CASE("ray marcher: thick media on the GPU", "[gpu][ray_marcher]") {
  scene::View view = look();
  view.width = 8, view.height = 6;
  for (int kind = 0; kind < 3; ++kind)
    for (const double extinction : {30.0, 300.0, 3000.0, 1e6}) {
      scene::DensityField field = scene::Homogeneous{1};
      if (kind == 1)
        field = scene::GaussianSum{{{Point3(0, 0, 0), 0.4, 1}, {Point3(0.3, 0.1, 0), 0.2, 2}}, 0, infinity};
      if (kind == 2) field = make_smoke(12, 0.18, Vec3(-1, -1, -1), Mat3::Identity());
      const auto scene = make_scene({make_medium(field, scene::Sphere{Point3::Zero(), 1}, Rgb::Constant(extinction),
                                                 Rgb::Constant(0.9), scene::HenyeyGreenstein{0.3})},
                                    {scene::DirectionalLight{Vec3(0.4, 0.5, 1).normalized(), Rgb(3, 2, 1)}});
      scene->camera = view.camera;
      CAPTURE(kind, extinction);
      const gpu::ray_marcher::RayMarcher marcher;
      const auto reasons = marcher.supports(*scene, {marcher.settings(), {}});
      if (extinction > 1e5) {
        REQUIRE(reasons.size() == 1);
        CHECK_THAT(reasons[0], Catch::Contains("extinction times the largest coordinate"));
        continue;
      }
      REQUIRE(reasons.empty());
      const Given given{{"steps", "64"}, {"shadow_steps", "32"}};
      const scene::Rendering cpu = render(scene, view, given, 1), gpu = render_gpu(scene, view, given);
      // Places in single precision: what they are off in optical depths, by the edge of a constant medium, changes the
      // light as much.
      const bool thick = extinction > 1000;
      CHECK(p99(cpu.film, gpu.film, "airlight") < (kind == 0   ? 1e-6 * extinction
                                                   : kind == 1 ? (thick ? 7e-6 : 1.7e-6)
                                                               : (thick ? 2.5e-5 : 8e-6)));
      CHECK(gpu.counters.at("steps") == Approx(cpu.counters.at("steps")).epsilon(0.01));
      if (thick) continue;  // there the CPU goes its plain path, in double: other bits decide on what is divided
      CHECK(gpu.counters.at("shadow_steps") == Approx(cpu.counters.at("shadow_steps")).epsilon(0.05));
    }
}

}  // namespace parity_test
