// A warm frame of shadow planes stays on the device: nothing goes up or down, nothing is allocated, the host waits once.
#include <cstdlib>

#include "tests/gpu/shadow_planes/pictures.h"

namespace frame_test {

using namespace airlight;
using gpu::test::Pairs;
using gpu::test::scene_of;

namespace {

std::shared_ptr<scene::Scene> moved(const scene::Scene& from) {
  auto to = std::make_shared<scene::Scene>(from);
  for (scene::Light& light : to->lights) light = scene::moved(light, {0.02, -0.01, 0.03});
  return to;
}

const Pairs vertices{{"shadows", "stencil"}, {"evaluation", "vertices"}};

}  // namespace

TEST_CASE("shadow planes: a warm frame stays on the device", "[gpu][shadow_planes]") {
  if (!gpu::test::device()) return;
  const gpu::ShadowPlanesGpu method;
  scene::Execution all{1, {}}, none = all, one = all;
  none.layers.emplace();
  one.layers = {"airlight"};
  Pairs paper = vertices;
  paper["bounded"] = "paper";
  const std::pair<const char*, Pairs> cases[] = {{"boxes_8", {}},       {"boxes_8", {{"shadows", "stencil"}}},
                                                 {"boxes_8", vertices}, {"media", {}},
                                                 {"media", paper},      {"spot", {}}};
  for (const auto& [name, given] : cases) {
    CAPTURE(name, given);
    const auto scene = scene_of(std::string("shadow_planes/") + name, 40, 30);
    const auto there = moved(*scene);
    const scene::View view = view_of(*scene);
    const auto prepared = method.prepare(scene, {method.settings(), given}, all);
    const scene::Rendering first = prepared->render(view, all);
    REQUIRE(prepared->next(there, all));  // a frame that finds silhouettes has a stage more, and two queries
    prepared->render(view, all);
    const auto warm = [&](const std::shared_ptr<const scene::Scene>& at, const scene::Execution& execution) {
      const auto times = prepared->next(at, execution);
      REQUIRE(times);
      CHECK(times->empty());
      scene::Rendering rendering = prepared->render(view, execution);
      CHECK(rendering.counters["bytes_up"] == 0);
      CHECK(rendering.counters["syncs"] == 1);
      CHECK(rendering.counters["allocations"] == 0);
      CHECK(rendering.counters["look_ups"] == 0);
      CHECK(rendering.counters["draws"] == 0);
      CHECK(rendering.counters["dispatches"] <= 30);
      return rendering;
    };
    scene::Rendering unread = warm(there, none);
    CHECK(unread.counters["bytes_down"] == 0);
    CHECK(unread.film.layers.empty());
    const scene::Rendering airlight = warm(scene, one);
    CHECK(airlight.film.layers.size() == 1);
    CHECK(airlight.film.layer("airlight") == first.film.layer("airlight"));
    // A layer; counters, and what is known of each light.
    CHECK(airlight.counters.at("bytes_down") == 40 * 30 * 12 + 48 + 32);
    CHECK(warm(there, all).film.layers ==
          method.prepare(there, {method.settings(), given}, all)->render(view, all).film.layers);
  }
}

// Buffers hold NaN and -1 before each frame: whoever reads what nobody wrote shows another picture.
TEST_CASE("shadow planes: no pass reads what none has written", "[gpu][shadow_planes][thorough]") {
  if (!gpu::test::device()) return;
  const auto picture = [](const std::shared_ptr<const scene::Scene>& scene, const Pairs& given) {
    const gpu::ShadowPlanesGpu method;
    const auto prepared = method.prepare(scene, {method.settings(), given}, {1, {}});
    prepared->render(view_of(*scene), {1, {}});
    prepared->next(moved(*scene), {1, {}});
    return prepared->render(view_of(*scene), {1, {}}).film.layers;
  };
  Pairs paper = vertices;
  paper["bounded"] = "paper";
  auto two_lights = scene_of("shadow_planes/boxes_8", 24, 18);
  two_lights->lights.push_back(scene::moved(two_lights->lights[0], {0.5, 0.1, -0.2}));
  two_lights->camera.kind = scene::Camera::Kind::orthographic;
  two_lights->camera.height = 5;
  auto dark = scene_of("shadow_planes/boxes_1", 24, 18);
  dark->lights.clear();
  const std::pair<std::shared_ptr<scene::Scene>, Pairs> cases[] = {
      {scene_of("shadow_planes/boxes_8", 24, 18), vertices},
      {scene_of("shadow_planes/media", 24, 18), paper},
      {two_lights, {}},
      {dark, {}}};
  for (const auto& [scene, given] : cases) {
    CAPTURE(scene->name, given);
    const auto expected = picture(scene, given);
    setenv("AIRLIGHT_GPU_POISON", "1", 1);
    const auto poisoned = picture(scene, given);
    unsetenv("AIRLIGHT_GPU_POISON");
    CHECK(poisoned == expected);
  }
}

}  // namespace frame_test
