// The ray marcher on the GPU against the ray marcher on the CPU: same settings, same steps, same picture to single
// precision; and against the truth by itself.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/program.h"
#include "gpu/ray_marcher/ray_marcher_gpu.h"
#include "reference/deterministic/airlight.h"
#include "scene/error.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/reference/ray_marcher/march_scenes.h"

using namespace airlight;
using gpu::test::p99;
using namespace airlight::ray_marcher;

namespace {

scene::View look() {
  scene::View view;
  view.camera = scene::look_at(Point3(0.4, 0.3, 4), Point3(0, 0, 0), Vec3::UnitY());
  view.camera.vertical_fov = 0.7;
  view.width = 21;  // no multiple of a tile
  view.height = 14;
  return view;
}

scene::Rendering render_gpu(std::shared_ptr<const scene::Scene> scene, const scene::View& view, const Given& given) {
  const gpu::RayMarcherGpu marcher;
  return marcher.prepare(std::move(scene), {marcher.settings(), given}, {1, {}})->render(view, {1, {}});
}

}  // namespace

// Every medium, region, phase function, kind of light and surface of the CPU's own tests.
TEST_CASE("ray marcher: GPU agrees with CPU", "[gpu][ray_marcher]") {
  if (!gpu::test::device()) return;
  double worst = 0;
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name == "overlap of all") continue;  // comes again with surfaces, and every program costs seconds to compile
    const scene::View view = look();
    for (Given given : {Given{}, Given{{"spacing", "uniform"}, {"steps", "40"}, {"empty_space_skipping", "false"}},
                        Given{{"step", "0.31"}, {"shadow_step", "0.23"}, {"early_exit", "0.05"}}}) {
      if (given.count("step") && scene->geometry) continue;  // seconds
      given.insert({{"shadow_steps", "12"}, {"environment_directions", "8"}});
      const scene::Rendering cpu = render(scene, view, given, 1), gpu = render_gpu(scene, view, given);
      CAPTURE(name, given["spacing"], given["step"]);
      for (const char* layer : {"airlight", "transmittance", "surface"}) {
        CAPTURE(layer);
        const double error = p99(cpu.film, gpu.film, layer);
        worst = std::max(worst, error);
        CHECK(error < 1e-4);  // measured: 8.5e-6 at worst
      }
      // The same steps: what rounding makes of a ray along a cut apart.
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
  INFO("worst 99th percentile: " << worst);
  CHECK(worst < 1e-4);
}

// Triangles, which the scenes above have not.
TEST_CASE("ray marcher: meshes cast shadows on the GPU", "[gpu][ray_marcher]") {
  if (!gpu::test::device()) return;
  const auto scene = std::make_shared<const scene::Scene>(
      scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/crosscheck/mesh_in_fog.toml"));
  scene::View view = view_of(*scene);
  view.width = 24, view.height = 18;
  const Given given{{"steps", "24"}, {"environment_directions", "4"}};
  const scene::Rendering cpu = render(scene, view, given, 1), gpu = render_gpu(scene, view, given);
  CHECK(p99(cpu.film, gpu.film, "airlight") < 2e-3);  // a step at a shadow's edge may fall to the other side
  CHECK(gpu.counters.at("occlusion_rays") == cpu.counters.at("occlusion_rays"));
  CHECK(gpu.counters.at("shadow_rays") == Approx(cpu.counters.at("shadow_rays")).epsilon(2e-3));
  CHECK(gpu.counters.at("shadow_rays") < 0.999 * gpu.counters.at("occlusion_rays"));  // some are hidden
}

TEST_CASE("ray marcher: exact shadows of Gaussians on the GPU", "[gpu][ray_marcher]") {
  if (!gpu::test::device()) return;
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name != "Gaussians") continue;
    const Given given{{"shadow", "exact"}};
    const scene::Rendering cpu = render(scene, look(), given, 1), gpu = render_gpu(scene, look(), given);
    CHECK(p99(cpu.film, gpu.film, "airlight") < 1e-4);
    CHECK(gpu.counters.at("shadow_steps") == 0);
  }
}

// Order 2, towards the closed reference and not towards the CPU's marcher.
TEST_CASE("ray marcher: the GPU reaches the deterministic truth at order 2", "[gpu][ray_marcher]") {
  if (!gpu::test::device()) return;
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

TEST_CASE("ray marcher: the GPU takes no step in empty space, nor makes a dispatch without a medium",
          "[gpu][ray_marcher]") {
  if (!gpu::test::device()) return;
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
  const gpu::RayMarcherGpu marcher;
  const auto objections = [&](const std::string& wanted, const Given& given) {
    for (const auto& [name, scene] : assorted_scenes())
      if (name == wanted) return marcher.supports(*scene, {marcher.settings(), given}).size();
    return std::size_t(99);
  };
  CHECK(objections("grid", {}) == 0);
  CHECK(objections("grid", {{"shadow", "exact"}}) == 1);
  CHECK(objections("Gaussians", {{"shadow", "exact"}}) == 0);
  CHECK(objections("Gaussians with a hole, cut off, over a constant, in a sphere", {{"shadow", "exact"}}) == 1);
  CHECK(objections("Gaussians", {{"kernel", "scalar"}}) == 1);
  if (!gpu::test::device()) return;
  for (const auto& [name, scene] : assorted_scenes())
    if (name == "Gaussians") {
      const auto prepared = marcher.prepare(scene, {marcher.settings(), {}}, {1, {}});
      CHECK_THROWS_AS(prepared->render(look(), {1, [](double) { return false; }}), scene::Interrupted);
    }
}
