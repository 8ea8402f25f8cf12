#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "scene/geometry/shapes.h"
#include "tests/scene/geometry_scenes.h"

namespace geometry_shapes_test {

using namespace airlight;
using namespace airlight::scene;

TEST_CASE("procedural meshes are closed and oriented", "[geometry]") {
  CHECK(volume(make_box({Point3(1, 2, 3), Point3(2, 4, 6)})) == Approx(6));
  CHECK_THROWS_AS(make_box({Point3(0, 0, 0), Point3(1, 0, 1)}), Error);
  const TriangleMesh terrain = make_height_field({3, 2, Point3(1, 10, 2), 0.5, 2, {0, 1, 2, 0, 1, 2}});
  CHECK(terrain.vertices.size() == 6);
  CHECK(terrain.triangles.size() == 4);
  CHECK(terrain.vertices[4] == Point3(1.5, 11, 4));
  // height = 2 (x - 1) above 10
  const Geometry geometry({surface_of(terrain)});
  const auto hit = geometry.first_hit({Point3(1.8, 20, 3), -Vec3::UnitY()});
  REQUIRE(hit);
  CHECK(hit->position[1] == Approx(11.6));
  CHECK(hit->normal.isApprox(Vec3(-2, 1, 0).normalized(), 1e-14));
  for (const auto& t : terrain.triangles)
    CHECK((terrain.vertices[t[1]] - terrain.vertices[t[0]]).cross(terrain.vertices[t[2]] - terrain.vertices[t[0]])[1] >
          0);
  CHECK_THROWS_AS(make_height_field({3, 2, Point3::Zero(), 1, 1, {0, 1, 2}}), Error);
  CHECK_THROWS_AS(make_height_field({2, 2, Point3::Zero(), 1, 1, {0, 1, 2, std::nan("")}}), Error);
}

}  // namespace geometry_shapes_test
