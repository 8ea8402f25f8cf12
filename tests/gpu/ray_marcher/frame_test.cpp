// What a frame of the ray marcher moves between host and device.
#include <catch2/catch.hpp>
#include <set>

#include "tests/gpu/ray_marcher/pictures.h"

namespace frame_test {

using namespace airlight;
using namespace airlight::ray_marcher;

// Counters go into tables: every one of them the same in every run, however busy the machine is. The first frame learns
// how many rounds there are (gpu/ray_marcher/rounds.h); a warm one takes them without a look, and gives the same bits.
TEST_CASE("ray marcher: a warm frame stays on the device", "[gpu][ray_marcher]") {
  if (!gpu::test::device()) return;
  for (const auto& [name, scene] : assorted_scenes()) {
    const bool several = name == "Gaussians";  // rounds
    if (!several && !scene->geometry) continue;
    CAPTURE(name);
    scene::View view = look();
    view.width = 28, view.height = 21;
    const gpu::RayMarcherGpu marcher;
    const Given given{
        {"steps", several ? "256" : "16"}, {"shadow_steps", several ? "32" : "4"}, {"environment_directions", "8"}};
    const auto prepared = marcher.prepare(scene, {marcher.settings(), given}, {1, {}});
    const auto cold = prepared->render(view, {1, {}}), warm = prepared->render(view, {1, {}});
    CHECK(warm.film.layers == cold.film.layers);
    for (const char* counter : {"rays", "steps", "shadow_rays", "shadow_steps", "occlusion_rays"})
      CHECK(warm.counters.at(counter) == cold.counters.at(counter));
    if (several) CHECK(warm.counters.at("dispatches") > 5);
    CHECK(warm.counters.at("bytes_down") < 12.0 * 4 * view.width * view.height + 1000);
    scene::Execution execution{1, {}};
    for (const std::set<std::string>& layers : {std::set<std::string>{}, {"mean"}}) {
      execution.layers = layers;
      for (int i = 0; i < 2; ++i) {
        const auto frame = prepared->render(view, execution);
        if (i == 0) continue;  // the buffer of downloads has grown
        CHECK(frame.film.layers.size() == layers.size());
        for (const std::string& layer : layers) CHECK(frame.film.layer(layer) == cold.film.layer(layer));
        CHECK((frame.counters.at("bytes_down") == 0) == layers.empty());
        CHECK(frame.counters.at("syncs") == 1);
        for (const char* counter : {"bytes_up", "allocations", "look_ups"}) CHECK(frame.counters.at(counter) == 0);
        CHECK(frame.counters.at("dispatches") == warm.counters.at("dispatches"));
      }
    }
  }
}

// More rounds than the frame before had: they are found to be too few, and the picture is made again.
TEST_CASE("ray marcher: rounds that were too few are seen", "[gpu][ray_marcher]") {
  if (!gpu::test::device()) return;
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name != "Gaussians") continue;
    const gpu::RayMarcherGpu marcher;
    const Given given{{"steps", "512"}, {"shadow_steps", "64"}};
    scene::View away = look();
    away.camera = scene::look_at(Point3(0, 0, 40), Point3(0, 0, 80), Vec3::UnitY());
    const auto prepared = marcher.prepare(scene, {marcher.settings(), given}, {1, {}});
    prepared->render(away, {1, {}});
    const auto frame = prepared->render(look(), {1, {}});
    CHECK(frame.counters.at("syncs") > 2);  // it looked
    CHECK(frame.film.layers == render_gpu(scene, look(), given).film.layers);
  }
}

}  // namespace frame_test
