// Transfers of a frame of the half-resolution march between host and device, and frames in parts.
#include <catch2/catch.hpp>
#include <set>

#include "gpu/half_resolution_march/half_resolution_march.h"
#include "gpu/ray_marcher/rounds.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"

namespace half_frame_test {

using namespace airlight;
using test::Given;

namespace {

const gpu::half_resolution_march::HalfResolutionMarch march;

std::unique_ptr<scene::Prepared> prepared(const std::shared_ptr<const scene::Scene>& scene, const Given& given) {
  return march.prepare(scene, {march.settings(), given}, {1, {}});
}

// Rounds as on a software renderer: a fast device would do these pictures in one.
struct ManyRounds {
  explicit ManyRounds(int budget) { gpu::ray_marcher::Rounds::budget = budget; }
  ~ManyRounds() { gpu::ray_marcher::Rounds::budget = 0; }
};

}  // namespace

// Surfaces and maps stay where they are, and so does the last picture.
DEVICE_TEST_CASE("half-resolution march: while the camera moves a warm frame stays on the device",
                 "[gpu][half_resolution_march]") {
  const auto at = [](double place) {
    auto scene = test::scene_named("elephant_fog", 40, 30);
    scene->camera.position += Vec3(0.01 * place, 0, 0);
    finish(*scene);
    return scene;
  };
  const Given given{{"reproject", "true"}, {"steps", "8"}, {"clamp", "neighbourhood"}};
  const auto frames = prepared(at(0), given);
  frames->render(view_of(*at(0)), {1, {}});
  for (int i = 1; i < 6; ++i) {
    const auto scene = at(i);
    const auto times = frames->next(scene, {1, {}});
    REQUIRE(times);
    CHECK(times->empty());
    scene::Execution execution{1, {}};
    execution.layers = std::set<std::string>{"mean"};
    const scene::Rendering frame = frames->render(view_of(*scene), execution);
    CHECK(frame.counters.at("history_used") > 200);
    if (i < 3) continue;  // two marched films, and the buffer of downloads
    CHECK(frame.counters.at("syncs") == 1);
    for (const char* counter : {"bytes_up", "allocations", "program_look_ups"}) {
      CAPTURE(counter);
      CHECK(frame.counters.at(counter) == 0);
    }
  }
  // A lamp that moved is another matter: maps are made anew, and the last picture is kept all the same.
  auto scene = at(5);
  for (scene::Light& light : scene->lights) light = scene::moved(light, Vec3(0.1, 0, 0));
  finish(*scene);
  const auto times = frames->next(scene, {1, {}});
  REQUIRE(times);
  CHECK_FALSE(times->empty());
  CHECK(frames->render(view_of(*scene), {1, {}}).counters.at("history_used") > 200);
}

// Where a ray stops until the next round changes nothing, though a round may end between two lights of a step.
DEVICE_TEST_CASE("half-resolution march: pictures and counters are the same in any rounds",
                 "[gpu][half_resolution_march]") {
  const auto scene = test::scene_named("crosscheck/surfaces_in_fog", 24, 18);
  const Given given{{"steps", "12"}, {"frames", "3"}, {"environment_directions", "8"}};
  scene::Rendering first;
  for (const int budget : {100000, 100, 10}) {
    CAPTURE(budget);
    const ManyRounds many(budget);
    const scene::Rendering picture = test::render(march, scene, given);
    if (budget == 100000) first = picture;
    CHECK(gpu::test::quantile(first.film, picture.film, "airlight", 1) < 1e-6);
    CHECK(gpu::test::quantile(first.film, picture.film, "transmittance", 1) < 1e-6);
    for (const char* counter : {"rays", "points", "look_ups", "occlusion_rays"})
      CHECK(picture.counters.at(counter) == first.counters.at(counter));
    CHECK((picture.counters.at("dispatches") > first.counters.at("dispatches")) == (budget < 100000));
  }
}

DEVICE_TEST_CASE("half-resolution march: a picture on the device can be stopped", "[gpu][half_resolution_march]") {
  const auto scene = test::scene_named("plume_sun", 24, 32);
  const auto frames = prepared(scene, {{"map_size", "32"}});
  CHECK_THROWS_AS(frames->render(view_of(*scene), {1, [](double) { return false; }}), scene::Interrupted);
  CHECK(frames->render(view_of(*scene), {1, {}}).film.layers ==
        frames->render(view_of(*scene), {1, [](double) { return true; }}).film.layers);
}

}  // namespace half_frame_test
