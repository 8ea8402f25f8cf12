// m where camera rays begin: the numbers of the processor, every one.
#include <catch2/catch.hpp>
#include <random>

#include "gpu/shadow_planes/surface_count.h"
#include "methods/shadow_planes/general_position.h"
#include "scene/geometry/shapes.h"
#include "tests/gpu/device.h"
#include "tests/methods/shadow_planes/special_scenes.h"
#include "tests/pictures.h"

namespace counts_test {

using namespace airlight;
using shadow_planes::origin_in_general_position;

namespace {

struct Counted {
  int points = 0, crossed = 0;  // m > 0
};

// Compares m on device and CPU for all pixels of a parallel view, and for cameras at some of their origins.
Counted compare(gpu::Context& context, const std::shared_ptr<const scene::Scene>& scene, const scene::View& view,
                const Point3& light) {
  const auto occluders = std::make_shared<const shadow_planes::Occluders>(scene);
  const shadow_planes::SurfaceCount expected(occluders, light);
  const gpu::shadow_planes::Silhouettes silhouettes(context, *occluders, 1);
  const gpu::FirstHits hits(context, *scene);
  const gpu::shadow_planes::OriginCounts counts(context, silhouettes, hits);
  gpu::shadow_planes::LightEdges edges;
  silhouettes.find(light, edges);
  const std::size_t pixels = std::size_t(view.width) * view.height;
  using gpu::shadow_planes::StateData;
  const gpu::Buffer states(context, "states", pixels * sizeof(StateData)), counters(context, "counters", 64);
  counts.find(view, light, edges, states, counters);
  const std::vector<StateData> found = states.download<StateData>();
  Counted result;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const Point3 origin = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height).origin;
      const int m = expected.at(origin_in_general_position(origin, light));
      CAPTURE(scene->name, x, y, light.transpose(), origin.transpose());
      CHECK(found[std::size_t(y) * view.width + x].m_origin == m);
      ++result.points;
      result.crossed += m > 0;
      if ((x + y) % 7 != 0) continue;
      scene::View from_there = view;
      from_there.camera.kind = scene::Camera::Kind::perspective;
      from_there.camera.position = origin;
      counts.find(from_there, light, edges, states, counters);
      const auto state = edges.state->download<int>();
      CHECK(state[offsetof(gpu::shadow_planes::LightStateData, count_at_camera) / 4] ==
            expected.at(origin_in_general_position(origin, light)));
    }
  return result;
}

scene::View parallel_view(const Point3& at, const Point3& target, double height, int width, int rows) {
  scene::View view{scene::look_at(at, target, {0, 1, 0}), width, rows};
  view.camera.kind = scene::Camera::Kind::orthographic;
  view.camera.height = height;
  return view;
}

}  // namespace

DEVICE_TEST_CASE("shadow planes: surfaces between light and origins are counted alike", "[gpu][shadow_planes]") {
  const gpu::Use use(context);
  Counted all;
  const auto add = [&](const std::shared_ptr<const scene::Scene>& scene, const scene::View& view, const Point3& light) {
    const Counted counted = compare(context, scene, view, light);
    all.points += counted.points;
    all.crossed += counted.crossed;
  };
  // Lights in the planes of faces and edges, spheres, cards with two sides; origins on a grid of round numbers, where rays pass
  // through vertices and along edges, in front of all and in the middle.
  for (const auto& scene : test::special_scenes()) {
    const Point3 light = scene::ball(scene->lights[0])->center;
    add(scene, parallel_view({0, 0, 6}, {0, 0, 0}, 8, 16, 16), light);
    add(scene, parallel_view({0.3, -3, 0.1}, {0, 0, 0}, 7, 9, 9), light);
  }
  // Boxes that cut one another, with faces missing or there twice; lights at corners, in walls, inside.
  for (unsigned seed = 0; seed < 6; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1, 1), size(0.1, 0.8);
    auto scene = std::make_shared<scene::Scene>();
    scene->name = "soup " + std::to_string(seed);
    for (int i = 0; i < 12; ++i) {
      const Point3 corner(place(random), place(random), place(random));
      scene::TriangleMesh box = scene::make_box({corner, corner + Vec3(size(random), size(random), size(random))});
      if (seed % 3 == 1) box.triangles.resize(7);
      if (seed % 3 == 2) box.triangles.insert(box.triangles.end(), box.triangles.begin(), box.triangles.begin() + 5);
      scene->surfaces.push_back({"box", box, scene::Lambert{}});
    }
    scene->surfaces.push_back({"floor", scene::Plane{{0, -0.7, 0}, {0, 1, 0}}, scene::Lambert{}});
    scene->surfaces.push_back({"ball", scene::Sphere{{0.2, 0.1, -0.3}, 0.4}, scene::Lambert{}});
    finish(*scene);
    const auto& first = std::get<scene::TriangleMesh>(scene->surfaces[0].shape).vertices;
    const scene::View view = parallel_view({0, 0, 0.05}, {0, 0, -1}, 4, 20, 20);
    for (const Point3& light : {Point3(0.3, 1.9, -0.2), first.front(), Point3(0.5 * (first[0] + first[1])),
                                Point3(0.5 * (first.front() + first.back())), Point3(1e5, 2e5, -1e5)})
      add(scene, view, light);
  }
  add(test::scene_named("elephant_fog", 8, 8), parallel_view({0, 0, 0}, {0.2, -0.1, -1}, 1, 16, 16), {0.1, 2, 0.3});
  CHECK(all.points > 14000);
  CHECK(all.crossed > 3000);
}

}  // namespace counts_test
