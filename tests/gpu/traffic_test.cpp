// Traffic between processor and device in a warm frame of every GPU method: nothing that nobody asked for.
#include <catch2/catch.hpp>
#include <numeric>

#include "gpu/compensated_ray_marching/compensated_ray_marching.h"
#include "gpu/fogshop/fogshop.h"
#include "gpu/frame.h"
#include "gpu/ray_marcher/ray_marcher.h"
#include "gpu/shadow_planes/shadow_planes.h"
#include "gpu/wavelet_fog/wavelet_fog.h"
#include "tests/gpu/device.h"
#include "tests/pictures.h"

namespace traffic_test {

using namespace airlight;
using test::Given;
using test::scene_named;

namespace {

struct Case {
  const scene::Renderer& method;
  const char* scene;
  Given given;
  bool lights_move = false;
};

double sum(const std::vector<scene::StageTime>& times) {
  return std::accumulate(times.begin(), times.end(), 0.0, [](double s, const auto& time) { return s + time.seconds; });
}

}  // namespace

DEVICE_TEST_CASE("a warm frame of every GPU method stays on the device", "[gpu][slow][thorough]") {
  const gpu::fogshop::Fogshop fogshop;
  const gpu::shadow_planes::ShadowPlanes planes;
  const gpu::ray_marcher::RayMarcher marcher;
  const gpu::wavelet_fog::WaveletFog fogmaps;
  const gpu::compensated_ray_marching::CompensatedRayMarching smoke;
  const Given printed{
      {"evaluator", "polynomial"}, {"shadows", "stencil"}, {"evaluation", "vertices"}, {"bounded", "paper"}};
  const std::vector<Case> cases{
      {fogshop, "fogshop/table1/gargoyle", {{"reflectance", "npsf"}}},
      {fogshop, "fogshop/table1/gargoyle", {{"variant", "paper"}, {"reflectance", "npsf"}}},
      {fogshop, "fogshop/table1/terrain", {{"reflectance", "npsf"}, {"downsample", "2"}}},
      {fogshop, "fogshop/tube", {{"K", "26"}}},
      {planes, "shadow_planes/fig1", {}, true},
      {planes, "shadow_planes/fig8b", printed, true},
      {marcher, "shadow_planes/fig8b", {{"steps", "16"}, {"shadow_steps", "4"}}},
      {fogmaps, "wavelet_fog/valley", {}, true},
      {fogmaps, "wavelet_fog/valley", {{"variant", "polar"}}, true},
      {fogmaps, "wavelet_fog/patchy", {{"variant", "paper"}}},
      {fogmaps, "wavelet_fog/valley", {{"sun", "true"}}, true},
      {smoke, "compensated_ray_marching/gaussians_lobe", {{"cells", "12"}}, true},
      {smoke, "compensated_ray_marching/gaussians_lobe", {{"cells", "12"}, {"multiple", "p1"}}, true},
      {smoke, "compensated_ray_marching/gaussians_lobe", {{"variant", "paper"}, {"iterations", "10"}}, true},
      {smoke, "compensated_ray_marching/plume_and_ball", {{"cells", "12"}, {"levels", "4"}}, true},
  };
  for (const Case& c : cases) {
    CAPTURE(c.method.name(), c.scene, c.given);
    const auto scene = scene_named(c.scene, 20, 15);
    const scene::View view = view_of(*scene);
    const auto prepared = c.method.prepare(scene, {c.method.settings(), c.given}, {1, {}});
    scene::Execution none{1, {}}, all{1, {}}, mean{1, {}};
    none.layers.emplace();
    mean.layers = {"mean"};
    const scene::Rendering cold = prepared->render(view, none);
    prepared->render(view, all);
    auto moved = std::make_shared<scene::Scene>(*scene);
    for (scene::Light& light : moved->lights) {
      light = scene::moved(light, {1e-3, 0, 0});
      if (&c.method == &smoke) light = scene::turned(light, 1e-3);
    }
    if (c.lights_move) REQUIRE(prepared->next(moved, none));

    scene::Rendering warm = prepared->render(view, none);
    const std::vector<scene::StageTime> host = gpu::host_times_of_last_frame();
    CHECK(warm.film.layers.empty());
    CHECK(warm.counters["bytes_down"] == 0);
    CHECK(warm.counters["syncs"] == 1);
    CHECK(warm.counters["allocations"] == 0);
    CHECK(warm.counters["program_look_ups"] == 0);
    CHECK(warm.counters["bytes_up"] <= 1024);  // a camera, lights: nothing that grows with the scene
    CHECK(warm.counters["dispatches"] > 0);
    // The processor's part, by the same stages, is a part of the frame.
    REQUIRE(host.size() == warm.times.size());
    for (std::size_t i = 0; i < warm.times.size(); ++i) {
      CHECK(warm.times[i].name != "download");
      CHECK(host[i].name == warm.times[i].name);
      CHECK(host[i].seconds >= 0);
    }
    CHECK(sum(host) > 0);
    UNSCOPED_INFO(fmt::format("{} on {}: {:.2g} ms on the processor, {} dispatches, {} draws, {} bytes up",
                              c.method.name(), c.scene, 1e3 * sum(host), warm.counters["dispatches"],
                              warm.counters["draws"], warm.counters["bytes_up"]));

    const std::size_t layer = 12 * scene::Film(view.width, view.height).pixels();
    scene::Rendering one = prepared->render(view, mean), full = prepared->render(view, all);
    CHECK(one.film.layers.size() == 1);
    CHECK(one.film.layer("mean") == full.film.layer("mean"));
    for (scene::Rendering* rendering : {&one, &full}) {
      const double layers = double(rendering->film.layers.size() * layer);
      CHECK(rendering->counters["bytes_down"] >= layers);
      CHECK(rendering->counters["bytes_down"] <= layers + 1024);  // counters and marks
      CHECK(rendering->counters["syncs"] == 1);
      CHECK(rendering->counters["allocations"] == 0);
      CHECK(rendering->times.back().name == "download");
    }
  }
}

}  // namespace traffic_test
