// Edges by angle: nothing that a ray crosses may be missing.
#include "methods/shadow_planes/edge_fan.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "scene/geometry/shapes.h"
#include "scene/renderer.h"

namespace edge_fan_test {

using namespace airlight;
using namespace airlight::shadow_planes;

namespace {

std::shared_ptr<scene::Scene> boxes(std::mt19937_64& random, int count) {
  std::uniform_real_distribution<double> place(-1, 1), size(0.01, 0.5);
  auto scene = std::make_shared<scene::Scene>();
  for (int i = 0; i < count; ++i) {
    const Point3 lo(place(random), place(random), place(random));
    scene->surfaces.push_back(
        {"box", scene::make_box({lo, lo + Vec3(size(random), size(random), size(random))}), scene::Lambert{}});
  }
  finish(*scene);
  return scene;
}

}  // namespace

TEST_CASE("shadow planes: a fan misses no crossing", "[shadow_planes]") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> place(-2, 2);
  double all_crossings = 0, candidates = 0, edges = 0;
  for (int k = 0; k < 40; ++k) {
    const auto scene = boxes(random, 12);
    scene::View view{scene::look_at({place(random), place(random), place(random)}, {0, 0, 0}, {0, 1, 0}), 64, 48};
    Point3 light(place(random), place(random), place(random));
    if (k % 4 == 1) view.camera.kind = scene::Camera::Kind::orthographic;
    // In view, so that rays pass close to the line between camera and light; right beside the camera; at it.
    if (k % 4 == 2) light = 0.3 * view.camera.position;
    if (k % 8 == 3) light = view.camera.position + 1e-7 * Vec3(1, 2, -1);
    if (k % 8 == 7) light = view.camera.position;
    const ShadowVolumes shadows(std::make_shared<const Occluders>(scene), light);
    const EdgeFan fan(shadows, view.camera);
    std::vector<Crossing> expected, got;
    std::vector<int> of_ray;
    for (int y = 0; y < view.height; y += 3)
      for (int x = 0; x < view.width; x += 3) {
        const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
        expected.clear();
        got.clear();
        shadows.cross_edges(ray, 10, shadows.all_edges(), expected);
        fan.of_ray(ray, of_ray);
        shadows.cross_edges(ray, 10, of_ray, got);
        std::sort(got.begin(), got.end(), [](const Crossing& a, const Crossing& b) { return a.edge < b.edge; });
        REQUIRE(got.size() == expected.size());
        for (std::size_t i = 0; i < got.size(); ++i)
          CHECK((got[i].edge == expected[i].edge && got[i].x == expected[i].x && got[i].change == expected[i].change));
        all_crossings += double(expected.size());
        candidates += double(of_ray.size());
        edges += double(shadows.edges().size());
      }
  }
  CHECK(all_crossings > 10000);
  // Few are offered that are not crossed.
  CAPTURE(all_crossings, candidates, edges);
  CHECK(candidates < 0.35 * edges);
}

// A ray straight at the light is met by everything, whatever its angle is.
TEST_CASE("shadow planes: a ray along the fan's line", "[shadow_planes]") {
  std::mt19937_64 random(3);
  const auto scene = boxes(random, 5);
  const scene::Camera camera = scene::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  const ShadowVolumes shadows(std::make_shared<const Occluders>(scene), {0, 0, 1});
  const EdgeFan fan(shadows, camera);
  std::vector<int> edges;
  fan.of_ray({camera.position, -Vec3::UnitZ()}, edges);
  CHECK(edges.size() == shadows.edges().size());
  fan.of_ray({camera.position, Vec3(1e-9, 0, -1)}, edges);
  CHECK(edges.size() == shadows.edges().size());
  fan.of_ray({camera.position, Vec3(0.3, 0, -1).normalized()}, edges);
  CHECK(edges.size() < shadows.edges().size());
}

}  // namespace edge_fan_test
