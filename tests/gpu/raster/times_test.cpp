// Not a test but a measurement, by name only: airlight_tests "[times]". Times of the stages that surfaces take.
#include <fmt/format.h>

#include <chrono>

#include "gpu/fogshop/fogshop_gpu.h"
#include "gpu/raster/light_distances.h"
#include "gpu/raster/raster_hits.h"
#include "gpu/timer.h"
#include "methods/fogshop/surface_pass.h"
#include "tests/gpu/device.h"
#include "tests/scene/geometry_scenes.h"

using namespace airlight;

TEST_CASE("times of the raster pass", "[.][times]") {
  gpu::Context* context = gpu::test::device();
  if (!context) return;
  scene::Scene elephant = scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/elephant_gaussians.toml",
                                            {{"film.width", "800"}, {"film.height", "600"}});
  scene::Scene torus = elephant;
  torus.surfaces[0] = scene::surface_of(moved(scene::torus(700, 350), 0.35, Vec3::Zero()));
  finish(torus);
  fmt::print("{}\n", context->description());
  for (const auto& [name, scene] : {std::pair{"elephant, 5558 triangles", elephant}, {"torus, 490000", torus}}) {
    const gpu::FogshopGpu method;
    const auto shared = std::make_shared<const scene::Scene>(scene);
    const auto prepared = method.prepare(shared, {method.settings(), {{"reflectance", "npsfT"}}}, {});
    std::map<std::string, double> best;
    for (const auto& t : prepared->prepare_times()) best["prepare: " + t.name] = t.seconds;
    for (int n = 0; n < 5; ++n)
      for (const auto& t : prepared->render(view_of(scene), {}).times)
        if (const auto at = best.try_emplace(t.name, t.seconds).first; t.seconds < at->second) at->second = t.seconds;
    const gpu::FirstHits traced(*context, scene);
    gpu::RasterHits raster(*context, scene);
    const std::size_t bytes = std::size_t(scene.width) * scene.height * 4;
    const gpu::Buffer distances(*context, "distances", bytes), primitives(*context, "primitives", bytes);
    for (int n = 0; n < 5; ++n) {
      gpu::StageTimer timer(*context);
      traced.find(view_of(scene), distances, &primitives);
      timer.stage("first hits, traced");
      const auto& image = raster.draw(view_of(scene));
      image.read_distances(distances, 0);
      image.read_primitives(primitives, 0);
      timer.stage("first hits, raster");
      for (const auto& t : timer.times())
        if (const auto at = best.try_emplace(t.name, t.seconds).first; t.seconds < at->second) at->second = t.seconds;
    }
    const auto start = std::chrono::steady_clock::now();
    fogshop::first_hits(scene, view_of(scene), {});
    best["Embree, first hits"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{}:\n", name);
    for (const auto& [stage, seconds] : best) fmt::print("  {:<32} {:8.2f} ms\n", stage, 1e3 * seconds);
  }
}
