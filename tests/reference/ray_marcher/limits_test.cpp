// Settings that would take hours or gigabytes are refused in one line, before anything is allocated.
#include "reference/ray_marcher/limits.h"

#include <catch2/catch.hpp>

#include "reference/ray_marcher/tile.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace limits_test {

using namespace airlight;
using namespace airlight::ray_marcher;

namespace {

std::vector<std::string> reasons(const scene::Scene& scene, const Given& given) {
  const RayMarcher marcher;
  return marcher.supports(scene, scene::Settings(marcher.settings(), given));
}

std::shared_ptr<scene::Scene> smoke() {
  return make_scene({make_medium(make_smoke(16, 0.125, Vec3(-1, -1, -1), Mat3::Identity()), scene::Unbounded{},
                                 Rgb(2, 3, 4), Rgb::Constant(0.8))},
                    {scene::PointLight{Point3(1.5, 2, 1), Rgb(5, 4, 3), 0}});
}

}  // namespace

TEST_CASE("ray marcher: settings out of range and too much work are refused", "[ray_marcher]") {
  const auto scene = smoke();
  const auto refused = [&](const scene::Scene& s, const Given& given, const std::string& part) {
    const auto found = reasons(s, given);
    CAPTURE(part);
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Catch::Contains(part));
    CHECK(found[0].find('\n') == std::string::npos);
    CHECK_THROWS_WITH(
        RayMarcher().prepare(std::make_shared<scene::Scene>(s), scene::Settings(RayMarcher().settings(), given), {}),
        Catch::Contains(part));
  };
  refused(*scene, {{"step", "1e-200"}}, "step = 1e-200 is out of range, expected 0, or 0.001 to 1000000");
  refused(*scene, {{"shadow_step", "1e-9"}}, "shadow_step = 1e-09 is out of range");
  CHECK(reasons(*scene, {{"step", "0.001"}}).empty());  // 3e4 steps
  CHECK(reasons(*scene, {{"step", "1e6"}}).empty());
  // 16 samples and their borders: 17 voxels, 29 along the diagonal; in metres of 1 km of fog, too many.
  auto fog = make_scene(
      {make_medium(scene::Homogeneous{1}, scene::Sphere{Point3::Zero(), 500}, Rgb::Constant(0.01), Rgb::Ones())},
      {scene::PointLight{Point3(1.5, 2, 1), Rgb(5, 4, 3), 0}});
  refused(*fog, {{"step", "0.001"}}, "step = 0.001 asks for 1.73e+06 steps along a ray, expected at most 131072");
  // 16384^2 pixels * 1e5 steps * 1e5 shadow steps.
  scene->width = scene->height = 16384;
  refused(*scene, {{"steps", "100000"}, {"shadow_steps", "100000"}}, "2.7e+18 evaluations, expected at most 1e+14");
  CHECK(reasons(*scene, {}).empty());
  scene->width = scene->height = 1;
  for (int i = 0; i < 100; ++i) scene->lights.push_back(scene->lights[0]);
  refused(*scene, {{"steps", "100000"}}, "1e+05 steps for each of 1 + 101 marches along a ray");
  CHECK_THROWS_WITH(reasons(*scene, {{"steps", "200000"}}), Catch::Contains("expected 1 to 131072"));
}

// Rays are marched fewer at a time where they have many steps: the picture has the same bits as ray by ray.
TEST_CASE("ray marcher: memory does not grow with the steps of a tile", "[ray_marcher]") {
  const auto scene = smoke();
  scene::View view;
  view.camera = scene::look_at(Point3(0.2, 0.3, 4), Point3::Zero(), Vec3::UnitY());
  view.width = 3, view.height = 3;
  const Given given{{"steps", "60000"}, {"shadow_steps", "2"}};
  const scene::Film all = render(scene, view, given).film;
  const Plan plan = plan_for(scene, given);
  TileMarcher one;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      Counters counters;
      const auto& pixels = one.march(plan, {camera_ray(view.camera, x + 0.5, y + 0.5, 3, 3)}, counters);
      for (int c = 0; c < 3; ++c) CHECK(all.get("airlight", x, y)[c] == float(pixels[0].airlight[c]));
    }
}

}  // namespace limits_test
