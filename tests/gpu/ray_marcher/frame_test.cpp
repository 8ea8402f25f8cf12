// Transfers of a frame of the ray marcher between host and device.
#include <catch2/catch.hpp>
#include <set>

#include "gpu/ray_marcher/rounds.h"
#include "tests/gpu/ray_marcher/pictures.h"

namespace frame_test {

using namespace airlight;
using namespace airlight::ray_marcher;

namespace {

// Rounds as on a software renderer: a fast device would do these pictures in one.
struct ManyRounds {
  explicit ManyRounds(int budget = 3000) { gpu::ray_marcher::Rounds::budget = budget; }
  ~ManyRounds() { gpu::ray_marcher::Rounds::budget = 0; }
};

}  // namespace

// Counters go into tables: every one of them the same in every run, however busy the machine is. The first frame learns
// how many rounds there are (gpu/ray_marcher/rounds.h); a warm one takes them without a look, and gives the same bits.
DEVICE_TEST_CASE("ray marcher: a warm frame stays on the device", "[gpu][ray_marcher][thorough]") {
  const ManyRounds many;
  for (const auto& [name, scene] : assorted_scenes()) {
    const bool several = name == "Gaussians";  // rounds
    if (!several && !scene->geometry) continue;
    CAPTURE(name);
    scene::View view = look();
    view.width = 28, view.height = 21;
    const gpu::ray_marcher::RayMarcher marcher;
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
        for (const char* counter : {"bytes_up", "allocations", "program_look_ups"})
          CHECK(frame.counters.at(counter) == 0);
        CHECK(frame.counters.at("dispatches") == warm.counters.at("dispatches"));
      }
    }
  }
}

// More rounds than the frame before had: they are found to be too few, and the picture is made again.
DEVICE_TEST_CASE("ray marcher: rounds that were too few are seen", "[gpu][ray_marcher]") {
  const ManyRounds many;
  for (const auto& [name, scene] : assorted_scenes()) {
    if (name != "Gaussians") continue;
    const gpu::ray_marcher::RayMarcher marcher;
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

// Where a ray stops until the next round changes nothing: thick Gaussians, whose steps are divided, in rounds of three lengths.
DEVICE_TEST_CASE("ray marcher: pictures and counters are the same in any rounds", "[gpu][ray_marcher]") {
  const auto scene = make_scene(
      {make_medium(scene::GaussianSum{{{Point3(0, 0, 0), 0.4, 1}, {Point3(0.3, 0.1, 0), 0.2, 2}}, 0, infinity},
                   scene::Sphere{Point3::Zero(), 1}, Rgb::Constant(300), Rgb::Constant(0.9), scene::Isotropic{})},
      {scene::DirectionalLight{Vec3(0.4, 0.5, 1).normalized(), Rgb(3, 2, 1)}});
  scene::View view = look();
  view.width = 8, view.height = 6;
  const Given given{{"steps", "64"}, {"shadow_steps", "32"}};
  const scene::Rendering cpu = render(scene, view, given, 1);
  scene::Rendering first;
  for (const int budget : {5000, 1000, 50}) {
    CAPTURE(budget);
    const ManyRounds many(budget);
    const scene::Rendering picture = render_gpu(scene, view, given);
    if (budget == 5000) first = picture;
    CHECK(gpu::test::p99(picture.film, first.film, "airlight") < 1e-6);  // light is added up in other portions
    CHECK(gpu::test::p99(picture.film, first.film, "transmittance") < 1e-6);
    for (const char* counter : {"steps", "shadow_steps", "shadow_rays"})
      CHECK(picture.counters.at(counter) == first.counters.at(counter));
    CHECK(picture.counters.at("steps") == Approx(cpu.counters.at("steps")).epsilon(0.01));
  }
}

}  // namespace frame_test
