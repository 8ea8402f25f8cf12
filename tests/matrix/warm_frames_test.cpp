// Cost of a frame that differs from the previous one in its camera or its lights, for every renderer on the
// device. Nothing is uploaded, nothing is allocated, the host waits once, and only the wanted layers are downloaded.
// The picture has the bits of a cold one.
#include <set>

#include "experiments/application/renderers.h"
#include "experiments/driver/next_frames.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/device.h"
#include "tests/methods/compensated_ray_marching/puffs.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace warm_frames_test {

using namespace airlight;
using test::Given;

namespace {

enum class Moves { camera, lights };

struct Case {
  const char *renderer, *scene;  // below experiments/scenes, or one of scene_of
  Given given;
  Moves moves;
  int dispatches, at_least;  // the most, and the least: equal where the number is known
  int status = 0, more = 0;  // bytes that come down in any frame, and with layers
};

const Given stencil{{"shadows", "stencil"}}, vertices{{"shadows", "stencil"}, {"evaluation", "vertices"}},
    printed{{"shadows", "stencil"}, {"evaluation", "vertices"}, {"bounded", "paper"}},
    marched{{"steps", "16"}, {"shadow_steps", "4"}},
    mapped{{"steps", "16"}, {"shadow", "map"}, {"map_size", "32"}, {"environment_directions", "4"}},
    few_steps{{"steps", "8"}, {"depth", "centre"}}, blurred{{"steps", "8"}, {"blur", "bilateral"}, {"map_size", "32"}},
    froxels{{"environment_directions", "4"}, {"map_size", "32"}}, systems{{"variant", "paper"}, {"n", "6"}},
    upwind{{"variant", "paper"}, {"n", "6"}, {"closure", "upwind"}};

// Shadow planes bring down counters, and what is known of each light. The paper's systems of Legendre fluids say how they ended.
const Case cases[] = {
    {"fogshop_gpu", "fogshop/f100", {}, Moves::camera, 9, 9},
    {"fogshop_gpu", "fogshop/f100", {{"variant", "paper"}, {"reflectance", "npsf"}}, Moves::camera, 6, 6},
    {"fogshop_gpu", "fogshop/posts", {{"downsample", "4"}}, Moves::camera, 17, 17},
    {"fogshop_gpu", "fogshop/posts", {{"downsample", "4"}, {"variant", "paper"}}, Moves::camera, 10, 10},
    {"fogshop_gpu", "fogshop/environment_cloud", {}, Moves::camera, 5, 5},
    {"fogshop_gpu", "fogshop/environment_cloud", {{"environment_airlight", "volume"}}, Moves::camera, 6, 6},
    {"shadow_planes_gpu", "shadow_planes/boxes_8", {}, Moves::lights, 30, 1, 0, 48 + 32},
    {"shadow_planes_gpu", "shadow_planes/boxes_8", stencil, Moves::lights, 30, 1, 0, 48 + 32},
    {"shadow_planes_gpu", "shadow_planes/boxes_8", vertices, Moves::lights, 30, 1, 0, 48 + 32},
    {"shadow_planes_gpu", "shadow_planes/media", {}, Moves::lights, 30, 1, 0, 48 + 32},
    {"shadow_planes_gpu", "shadow_planes/media", printed, Moves::lights, 30, 1, 0, 48 + 32},
    {"shadow_planes_gpu", "shadow_planes/spot", {}, Moves::lights, 30, 1, 0, 48 + 32},
    {"ray_marcher_gpu", "crosscheck/mesh_in_fog", marched, Moves::camera, 57, 1, 0, 128},
    {"ray_marcher_gpu", "crosscheck/mesh_in_fog", mapped, Moves::camera, 57, 1, 0, 128},
    {"half_resolution_march_gpu", "crosscheck/mesh_in_fog", few_steps, Moves::camera, 24, 1, 0, 144},
    {"half_resolution_march_gpu", "plume_sun", blurred, Moves::camera, 16, 1, 0, 96},
    {"froxel_fog_gpu", "crosscheck/mesh_in_fog", froxels, Moves::camera, 57, 1, 0, 32 + 12 + 48 + 48},
    {"froxel_fog_gpu", "fogshop/f100", {{"preset", "godot"}}, Moves::camera, 40, 1, 0, 32 + 12 + 48 + 48},
    {"wavelet_fog_gpu", "wavelet_fog/patchy", {{"variant", "skip"}}, Moves::camera, 2, 2, 0, 48},
    {"compensated_ray_marching_gpu", "puffs", {{"cells", "8"}}, Moves::camera, 19, 1},
    {"compensated_ray_marching_gpu", "puffs", {{"variant", "paper"}}, Moves::camera, 32, 1},
    {"legendre_fluids_gpu", "smoke", {}, Moves::lights, 5, 5},
    {"legendre_fluids_gpu", "smoke", systems, Moves::camera, 12, 1, 8, 8},
    {"legendre_fluids_gpu", "smoke", upwind, Moves::camera, 12, 1, 8, 8},
};

std::shared_ptr<scene::Scene> scene_of(const std::string& name) {
  if (name == "puffs") return test::scene_of(test::puffs(), 4, 0.9, test::uneven());
  if (name != "smoke") return test::scene_named(name, 40, 30);
  using namespace legendre_fluids::testing;
  return lit_scene(smoke(random_density({4, 4, 4}, 3), 1), oblique_light, oblique_view, 14, 11);
}

}  // namespace

DEVICE_TEST_CASE("a warm frame stays on the device, and is the cold one", "[gpu][warm]") {
  std::set<std::string> renderers;
  for (const Case& c : cases) {
    CAPTURE(c.renderer, c.scene, c.given);
    renderers.insert(c.renderer);
    const scene::Renderer& method = experiments::find_renderer(c.renderer, "warm_frames_test");
    const auto scene = scene_of(c.scene);
    const auto prepare = [&](const auto& at) { return method.prepare(at, {method.settings(), c.given}, {1, {}}); };
    const auto prepared = prepare(scene);
    auto there = scene;
    const auto frame = [&](double place, const std::optional<std::set<std::string>>& layers) {
      there = std::make_shared<scene::Scene>(*scene);
      if (c.moves == Moves::camera) there->camera.position += Vec3(0.01 * place, 0, 0);
      if (c.moves == Moves::lights) {
        for (scene::Light& light : there->lights) light = scene::moved(light, place * Vec3(0.02, -0.01, 0.03));
        experiments::turn_lights(*there, 0.02 * place);
        const auto times = prepared->next(there, {1, {}});
        REQUIRE(times);
        CHECK(times->empty());
      }
      scene::Execution execution{1, {}};
      execution.layers = layers;
      return prepared->render(view_of(*there), execution);
    };
    const auto check = [&](const scene::Rendering& warm) {
      CHECK(warm.counters.at("syncs") == 1);
      for (const char* counter : {"bytes_up", "allocations", "program_look_ups"}) {
        CAPTURE(counter);
        CHECK(warm.counters.at(counter) == 0);
      }
      if (c.moves == Moves::lights) CHECK(warm.counters.at("draws") == 0);
      CHECK(warm.counters.at("dispatches") <= c.dispatches);
      CHECK(warm.counters.at("dispatches") >= c.at_least);
    };
    frame(0, {});
    frame(1, {});  // a frame that finds silhouettes has a stage more, and two queries
    const scene::Rendering unread = frame(2, std::set<std::string>{});
    check(unread);
    CHECK(unread.film.layers.empty());
    CHECK(unread.counters.at("bytes_down") == c.status);
    const scene::Rendering one = frame(3, std::set<std::string>{"mean"});
    check(one);
    const scene::Film cold = prepare(there)->render(view_of(*there), {1, {}}).film;
    CHECK(one.film.layers.size() == 1);
    CHECK(one.film.layer("mean") == cold.layer("mean"));
    CHECK(one.counters.at("bytes_down") == 12 * double(cold.pixels()) + c.status + c.more);
    const scene::Rendering all = frame(3, {});
    check(all);
    CHECK(all.film.layers == cold.layers);
  }
  CHECK(renderers.size() == 8);
}

}  // namespace warm_frames_test
