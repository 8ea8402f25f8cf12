// Cameras, lights and edges in one plane; lights on surfaces.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/shadow_planes/shadow_planes.h"
#include "methods/shadow_planes/shadow_volumes.h"
#include "reference/deterministic/renderer.h"
#include "tests/methods/shadow_planes/special_scenes.h"
#include "tests/pictures.h"

namespace special_positions_test {

using namespace airlight;
using namespace airlight::shadow_planes;
using airlight::test::picture;

namespace {

// A box, and a light and points relative to it.
ShadowVolumes around_box(const Point3& light) {
  auto scene = std::make_shared<scene::Scene>();
  scene->surfaces.push_back({"box", scene::make_box({{-1, -1, -1}, {1, 1, 1}}), scene::Lambert{}});
  finish(*scene);
  return {std::make_shared<Occluders>(scene), light};
}

}  // namespace

TEST_CASE("shadow planes: cameras in the plane of an edge and the light", "[shadow_planes]") {
  for (const auto& scene : test::special_scenes()) {
    const scene::Film expected = picture(*deterministic::make_renderer(), scene);
    const scene::Film film = picture(ShadowPlanes(), scene);
    CAPTURE(scene->name);
    const std::vector<float>&x = expected.layer("airlight"), &y = film.layer("airlight");
    int wrong = 0, lit = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      wrong += !(std::abs(double(y[i]) - x[i]) <= 1e-6 * std::abs(x[i]) + 1e-9);
      lit += x[i] > 1e-9;
    }
    CHECK(wrong == 0);
    CHECK(lit > 300);
  }
}

// From the light through both diagonals, past corners and along faces.
TEST_CASE("shadow planes: surfaces on the way through their edges", "[shadow_planes]") {
  const ShadowVolumes before = around_box({5, 0, 0});
  CHECK(before.count({-5, 0, 0}) == 2);
  CHECK(before.count({0, 0, 0}) == 1);
  CHECK(before.count({2, 0, 0}) == 0);
  // A light as high as a face: the region that the face hides does not change.
  const ShadowVolumes level = around_box({5, 1, 0});
  CHECK(level.count({-5, 1.01, 0}) == 0);
  CHECK(level.count({-5, 0.99, 0}) == 2);
  CHECK(level.count({0, 0.99, 0}) == 1);
}

TEST_CASE("shadow planes: a light on a surface is before it", "[shadow_planes]") {
  for (const Point3& light : {Point3(0.3, 1, 0.2), Point3(1, 1, 0.2)}) {
    const ShadowVolumes shadows = around_box(light);
    CAPTURE(light.transpose());
    CHECK(shadows.count({3, 4, 5}) == 0);
    CHECK(shadows.count({0.1, 0.2, 0.3}) == 1);
    CHECK(shadows.count({-4, -3, -5}) == 2);
  }
  // On a sphere: what is on its side of the tangent plane is lit.
  for (const Vec3& up : {Vec3(0, 1, 0), Vec3(Vec3(0.3, -0.5, 0.7).normalized())}) {
    CHECK_FALSE(hides(-2 * up, 2, Vec3(up + 3 * up.unitOrthogonal())));
    CHECK(hides(-2 * up, 2, Vec3(-up + 3 * up.unitOrthogonal())));
    CHECK(hides(-2 * up, 2, Vec3(-up)));
  }
}

}  // namespace special_positions_test
