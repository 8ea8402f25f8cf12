// Not a test but a measurement, by name only: airlight_tests "[times]". Times of the stages that surfaces take.
#include <fmt/format.h>

#include <chrono>

#include "gpu/fogshop/fogshop.h"
#include "gpu/raster/first_hits.h"
#include "gpu/timer.h"
#include "methods/fogshop/surface_pass.h"
#include "tests/gpu/device.h"
#include "tests/scene/geometry_scenes.h"

namespace times_test {

using namespace airlight;

DEVICE_TEST_CASE("times of the raster pass", "[.][times]") {
  scene::Scene elephant = scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/elephant_gaussians.toml",
                                            {{"film.width", "800"}, {"film.height", "600"}});
  scene::Scene torus = elephant;
  torus.surfaces[0] = scene::surface_of(moved(scene::torus(700, 350), 0.35, Vec3::Zero()));
  finish(torus);
  fmt::print("{}\n", context.description());
  for (const auto& [name, scene] : {std::pair{"elephant, 5558 triangles", elephant}, {"torus, 490000", torus}}) {
    const gpu::fogshop::Fogshop method;
    const auto shared = std::make_shared<const scene::Scene>(scene);
    const auto prepared = method.prepare(shared, {method.settings(), {{"reflectance", "npsfT"}}}, {});
    std::map<std::string, double> best;
    for (const auto& t : prepared->prepare_times()) best["prepare: " + t.name] = t.seconds;
    for (int n = 0; n < 5; ++n)
      for (const auto& t : prepared->render(view_of(scene), {}).times)
        if (const auto at = best.try_emplace(t.name, t.seconds).first; t.seconds < at->second) at->second = t.seconds;
    const auto start = std::chrono::steady_clock::now();
    fogshop::first_hits(scene, view_of(scene), {});
    best["Embree, first hits"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{}:\n", name);
    for (const auto& [stage, seconds] : best) fmt::print("  {:<32} {:8.2f} ms\n", stage, 1e3 * seconds);
  }
}

DEVICE_TEST_CASE("times of first hits", "[.][times]") {
  for (const int width : {100, 800})
    for (const char* name :
         {"fogshop/table1/gargoyle", "fogshop/table1/box", "fogshop/table1/terrain", "fogshop/table1/city",
          "fogshop/table1/motorcycle", "shadow_planes/fig1", "shadow_planes/fig7", "shadow_planes/fig7_shade",
          "shadow_planes/fig8a", "shadow_planes/fig8b", "shadow_planes/fig8c", "shadow_planes/media"}) {
      const scene::Scene scene =
          scene::load_scene(fmt::format("{}/experiments/scenes/{}.toml", AIRLIGHT_SOURCE_DIR, name),
                            {{"film.width", std::to_string(width)}, {"film.height", std::to_string(width * 3 / 4)}});
      const gpu::FirstHits traced(context, scene);
      const gpu::FirstHits raster(context, scene, true, gpu::FirstHits::Way::raster);
      const gpu::Buffer distances(context, "distances", 480000 * 4), primitives(context, "primitives", 480000 * 4);
      std::vector<double> seconds[2];  // timestamps of a few milliseconds mean nothing on llvmpipe
      for (int n = 0; n < 7; ++n)
        for (int way = 0; way < 2; ++way) {
          const auto start = std::chrono::steady_clock::now();
          (way == 0 ? traced : raster).find(view_of(scene), distances, &primitives);
          distances.download<float>();
          seconds[way].push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
      for (auto& s : seconds) std::sort(s.begin(), s.end());
      fmt::print("{:4} {:<28} {:7} triangles  traced {:7.2f} ms  raster {:7.2f} ms\n", width, name,
                 traced.surfaces().triangles(), 1e3 * seconds[0][2], 1e3 * seconds[1][2]);
    }
}

}  // namespace times_test
