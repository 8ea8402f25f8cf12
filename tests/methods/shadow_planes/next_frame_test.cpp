// Prepared::next: frames whose lights have moved are those of a preparation of their own, on both sides.
#include <algorithm>
#include <catch2/catch.hpp>

#include "gpu/shadow_planes/shadow_planes_gpu.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "tests/gpu/device.h"

namespace next_frame_test {

using namespace airlight;

namespace {

std::shared_ptr<scene::Scene> moved(const scene::Scene& from, const Vec3& by) {
  auto to = std::make_shared<scene::Scene>(from);
  for (scene::Light& light : to->lights) light = scene::moved(light, by);
  return to;
}

double seconds(const std::vector<scene::StageTime>& times) {
  const auto found = std::find_if(times.begin(), times.end(), [](const auto& t) { return t.name == "silhouettes"; });
  return found == times.end() ? 0 : found->seconds;
}

void check(const scene::Renderer& method, std::map<std::string, std::string> given) {
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(
      "experiments/scenes/shadow_planes/boxes_3.toml", {{"film.width", "32"}, {"film.height", "24"}}));
  const scene::Settings settings(method.settings(), given);
  const scene::View view = view_of(*scene);
  const auto prepared = method.prepare(scene, settings, {1, {}});
  const scene::Film first = prepared->render(view, {1, {}}).film;
  const auto there = moved(*scene, {0.4, -0.2, 0.3});
  const auto times = prepared->next(there, {1, {}});
  REQUIRE(times);
  const scene::Rendering moved_frame = prepared->render(view, {1, {}});
  // A device finds them when the frame is drawn, and once.
  const double found = seconds(*times), drawn = seconds(moved_frame.times);
  CHECK((found > 0) == method.device().empty());
  CHECK((drawn > 0) != method.device().empty());
  CHECK(seconds(prepared->render(view, {1, {}}).times) == 0);
  const scene::Film& second = moved_frame.film;
  CHECK(second.layers == method.prepare(there, settings, {1, {}})->render(view, {1, {}}).film.layers);
  CHECK(second.layers != first.layers);
  REQUIRE(prepared->next(scene, {1, {}}));  // and back
  CHECK(prepared->render(view, {1, {}}).film.layers == first.layers);
  // Other surfaces, another number of lights: a preparation of its own, and this one is as it was.
  auto other = moved(*scene, {0, 0, 0});
  other->lights.push_back(other->lights[0]);
  CHECK_FALSE(prepared->next(other, {1, {}}));
  other->lights.pop_back();
  other->surfaces.clear();
  other->geometry = nullptr;
  CHECK_FALSE(prepared->next(other, {1, {}}));
  CHECK(prepared->render(view, {1, {}}).film.layers == first.layers);
}

}  // namespace

TEST_CASE("shadow planes: a light that moves", "[shadow_planes]") {
  const shadow_planes::ShadowPlanes method;
  check(method, {});
  check(method, {{"shadows", "stencil"}});
  check(method, {{"evaluation", "vertices"}, {"evaluator", "polynomial"}, {"shadows", "stencil"}});
}

TEST_CASE("shadow planes: a light that moves, on the device", "[gpu][shadow_planes]") {
  if (!gpu::test::device()) return;
  check(gpu::ShadowPlanesGpu(), {});
  check(gpu::ShadowPlanesGpu(), {{"shadows", "stencil"}, {"evaluation", "vertices"}});
}

}  // namespace next_frame_test
