// Prepared::next: frames whose lights have moved are those of a preparation of their own, on both sides.
#include <algorithm>
#include <catch2/catch.hpp>

#include "gpu/shadow_planes/shadow_planes.h"
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
  // No surfaces, another number of lights: a preparation of its own, and this one is as it was.
  auto other = moved(*scene, {0, 0, 0});
  other->lights.push_back(other->lights[0]);
  CHECK_FALSE(prepared->next(other, {1, {}}));
  other->lights.pop_back();
  other->surfaces.clear();
  other->geometry = nullptr;
  CHECK_FALSE(prepared->next(other, {1, {}}));
  CHECK(prepared->render(view, {1, {}}).film.layers == first.layers);
}

// One of the meshes elsewhere.
std::shared_ptr<scene::Scene> with_moved_caster(const scene::Scene& from, std::size_t which, const Vec3& by) {
  auto to = std::make_shared<scene::Scene>(from);
  std::size_t meshes = 0;
  for (scene::Surface& surface : to->surfaces)
    if (auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape); mesh && meshes++ == which)
      for (Point3& vertex : mesh->vertices) vertex += by;
  finish(*to);
  return to;
}

void check_casters(const scene::Renderer& method, std::map<std::string, std::string> given) {
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(
      "experiments/scenes/shadow_planes/boxes_3.toml", {{"film.width", "32"}, {"film.height", "24"}}));
  const scene::Settings settings(method.settings(), given);
  const scene::View view = view_of(*scene);
  const auto prepared = method.prepare(scene, settings, {1, {}});
  const scene::Rendering first = prepared->render(view, {1, {}});
  const auto meshes =
      double(std::count_if(scene->surfaces.begin(), scene->surfaces.end(), [](const scene::Surface& surface) {
        return std::holds_alternative<scene::TriangleMesh>(surface.shape);
      }));
  REQUIRE(meshes > 1);
  CHECK(first.counters.at("airlight_terms_made") == 1);
  CHECK(first.counters.at("silhouettes_made") == meshes);
  const auto by_caster = with_moved_caster(*scene, 1, {0.15, 0.1, -0.2}),
             by_light = moved(*by_caster, {0.4, -0.2, 0.3});
  const auto all = with_moved_caster(*by_light, 0, {-0.1, 0, 0.1});
  scene::Film before = first.film;
  for (const auto& there : {by_caster, by_light, all}) {
    REQUIRE(prepared->next(there, {1, {}}));
    const scene::Rendering frame = prepared->render(view, {1, {}});
    CHECK(frame.film.layers == method.prepare(there, settings, {1, {}})->render(view, {1, {}}).film.layers);
    CHECK(frame.film.layers != before.layers);
    CHECK(frame.counters.at("airlight_terms_made") == 0);
    // Section 5.1.1: of casters that move, of all where the light does. A device finds them all in one dispatch.
    const bool one = method.device().empty() && there != by_light;
    CHECK(frame.counters.at("silhouettes_made") == (one ? 1 : meshes));
    before = frame.film;
  }
  // Fog that gets thicker.
  auto thicker = std::make_shared<scene::Scene>(*all);
  for (scene::Medium& medium : thicker->media) medium.sigma_t *= 1.5;
  finish(*thicker);
  const bool became = prepared->next(thicker, {1, {}}).has_value();
  CHECK(became == method.device().empty());
  if (!became) return;
  const scene::Rendering frame = prepared->render(view, {1, {}});
  CHECK(frame.film.layers == method.prepare(thicker, settings, {1, {}})->render(view, {1, {}}).film.layers);
  CHECK(frame.film.layers != before.layers);
  CHECK(frame.counters.at("airlight_terms_made") == 1);
  CHECK(frame.counters.at("silhouettes_made") == 0);
}

}  // namespace

TEST_CASE("shadow planes: occluders that move, as if prepared anew", "[shadow_planes]") {
  const shadow_planes::ShadowPlanes method;
  check_casters(method, {});
  check_casters(method, {{"evaluation", "vertices"}, {"evaluator", "polynomial"}, {"shadows", "stencil"}});
}

DEVICE_TEST_CASE("shadow planes: occluders that move, as if prepared anew, on the device", "[gpu][shadow_planes]") {
  check_casters(gpu::shadow_planes::ShadowPlanes(), {});
  check_casters(gpu::shadow_planes::ShadowPlanes(), {{"shadows", "stencil"}, {"evaluation", "vertices"}});
}

TEST_CASE("shadow planes: a light that moves", "[shadow_planes]") {
  const shadow_planes::ShadowPlanes method;
  check(method, {});
  check(method, {{"shadows", "stencil"}});
  check(method, {{"evaluation", "vertices"}, {"evaluator", "polynomial"}, {"shadows", "stencil"}});
}

DEVICE_TEST_CASE("shadow planes: a light that moves, on the device", "[gpu][shadow_planes]") {
  check(gpu::shadow_planes::ShadowPlanes(), {});
  check(gpu::shadow_planes::ShadowPlanes(), {{"shadows", "stencil"}, {"evaluation", "vertices"}});
}

}  // namespace next_frame_test
