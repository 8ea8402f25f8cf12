// Reads of a frame of shadow planes on the device.
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

// Buffers hold NaN and -1 before each frame: whoever reads what nobody wrote shows another picture.
DEVICE_TEST_CASE("shadow planes: no pass reads what none has written", "[gpu][shadow_planes][thorough]") {
  const auto picture = [](const std::shared_ptr<const scene::Scene>& scene, const Pairs& given) {
    const gpu::shadow_planes::ShadowPlanes method;
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
