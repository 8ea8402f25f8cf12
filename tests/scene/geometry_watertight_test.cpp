// Rays against meshes where rounding hurts: edges, vertices, slivers, origins on the surface.
#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "scene/geometry/clean_mesh.h"
#include "scene/geometry/shapes.h"
#include "tests/scene/geometry_scenes.h"

namespace geometry_watertight_test {

using namespace airlight;
using namespace airlight::scene;

TEST_CASE("the tree finds what testing every triangle finds, bit for bit", "[geometry]") {
  Random random;
  const TriangleMesh mesh = torus(40, 24);
  const Geometry geometry({surface_of(mesh)});
  int hits = 0;
  for (const Ray& ray : hard_rays(mesh, {Point3::Constant(-4), Point3::Constant(4)}, 2000, random)) {
    const auto expected = brute_force(mesh, ray);
    const auto first = geometry.first_hit(ray);
    REQUIRE(first.has_value() == !expected.empty());
    REQUIRE(geometry.occluded(ray) == !expected.empty());
    if (expected.empty()) continue;
    ++hits;
    REQUIRE(first->t == expected[0].t);
    REQUIRE(geometry.all_hits(ray).size() == expected.size());
    // The limit is exclusive.
    REQUIRE_FALSE(geometry.occluded(ray, first->t));
    REQUIRE(geometry.occluded(ray, std::nextafter(first->t, infinity)));
    REQUIRE_FALSE(geometry.first_hit(ray, first->t));
  }
  CHECK(hits > 5000);
}

// From outside a closed mesh the crossings come in pairs, in and out by turns, also where the ray meets vertices and
// edges exactly or runs along them.
TEST_CASE("a closed mesh is watertight", "[geometry]") {
  Random random;
  for (const TriangleMesh& mesh : {torus(40, 24), make_box({Point3(-1, -1, -1), Point3(1, 1, 1)}),
                                   make_box({Point3(0.1, 0.2, 0.3), Point3(0.7, 0.9, 1.1)})}) {
    const Geometry geometry({surface_of(mesh)});
    const Box outside{Point3(2, 2, 2), Point3(4, 4, 4)};
    for (const Ray& ray : hard_rays(mesh, outside, 2000, random)) {
      const auto crossings = brute_force(mesh, ray);
      CAPTURE(mesh.triangles.size(), ray.origin.transpose(), ray.direction.transpose());
      REQUIRE(crossings.size() % 2 == 0);
      int depth = 0;
      for (const Crossing& crossing : crossings) depth += crossing.outward ? 1 : -1;
      REQUIRE(depth == 0);
      REQUIRE(geometry.all_hits(ray).size() % 2 == 0);
    }
  }
}

// Parallel rays on a grid: the sum of the lengths inside is the volume. The integrand is continuous with square-root
// edges: the midpoint rule errs by O(h^1.5); h = 0.01 on a silhouette of length 15 gives about 1e-3 of the volume at
// most.
TEST_CASE("chords add up to the volume", "[geometry]") {
  const TriangleMesh mesh = torus(40, 24);
  const Geometry geometry({surface_of(mesh)});
  const int n = 300;
  const double h = 3.0 / n;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const Ray ray{Point3(-1.5 + (i + 0.5) * h, 5, -1.5 + (k + 0.5) * h), -Vec3::UnitY()};
      const auto hits = geometry.all_hits(ray);
      for (std::size_t j = 0; j + 1 < hits.size(); j += 2) sum += hits[j + 1].t - hits[j].t;
    }
  CHECK(sum * h * h == Approx(volume(mesh)).epsilon(1e-3));
}

TEST_CASE("a point moved off its surface does not see it again", "[geometry]") {
  Random random;
  for (const double where : {0.0, 1.0, 1e6}) {
    const Vec3 shift(where, -where, where);
    const Sphere ball{Point3(0.5, 0.25, -0.125) + shift, 0.7};
    const TriangleMesh mesh = moved(make_box({Point3(-1, -1, -1), Point3(1, 1, 1)}), 1, shift);
    // The box rotated, so that no coordinate is exact.
    TriangleMesh turned = make_box({Point3(-1, -1, -1), Point3(1, 1, 1)});
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Point3& v : turned.vertices) v = turn * v + shift;
    const Plane ground{shift, Vec3(0.1, 1, -0.2).normalized()};
    for (const Surface& surface : {surface_of(mesh), surface_of(turned), surface_of(ball), surface_of(ground)}) {
      const Geometry geometry({surface});
      for (int i = 0; i < 5000; ++i) {
        const Ray ray{random.in({Point3::Constant(-3) + shift, Point3::Constant(3) + shift}), random.direction()};
        for (const Hit& hit : geometry.all_hits(ray)) {
          // Away from a convex surface nothing is hit, down to grazing directions.
          const bool inside = std::holds_alternative<TriangleMesh>(surface.shape)
                                  ? geometry.all_hits(ray).size() == 1
                                  : (ray.origin - ball.center).norm() < ball.radius;
          if (inside && !std::holds_alternative<Plane>(surface.shape)) continue;
          const Hit first = *geometry.first_hit(ray);
          if (first.t != hit.t) continue;
          const bool plane = std::holds_alternative<Plane>(surface.shape);
          const Vec3 tangent = hit.normal.cross(random.direction()).normalized();
          for (const double grazing : {1.0, 1e-3, 1e-9, 0.0}) {
            if (plane && grazing == 0) continue;  // parallel to rounding: meets it far away, and rightly
            const Vec3 out = (tangent + grazing * hit.normal).normalized();
            const Point3 origin = geometry.offset_origin(hit.position, hit.normal, hit.normal);
            CAPTURE(where, surface.shape.index(), grazing, (hit.position - shift).transpose(), hit.normal.transpose(),
                    out.transpose(), hit.normal.dot(out));
            REQUIRE_FALSE(geometry.occluded({origin, out}));
          }
          // Through it: the far side of a closed convex body is hit once, a plane not again.
          const Point3 beyond = geometry.offset_origin(hit.position, hit.normal, ray.direction);
          const std::size_t expected = plane ? 0 : 1;
          const double chord = geometry.all_hits(ray).back().t - hit.t;
          if (expected == 0 || chord > 1e-6) REQUIRE(geometry.all_hits({beyond, ray.direction}).size() == expected);
        }
      }
    }
  }
}

TEST_CASE("degenerate, sliver and duplicate triangles", "[geometry]") {
  TriangleMesh mesh;
  mesh.vertices = {Point3(0, 0, 0),   Point3(1, 0, 0),      Point3(0, 1, 0),
                   Point3(0.5, 0, 0), Point3(1, -1e-12, 0), Point3(1, 0, 0)};
  // One triangle three times (rotated, with a repeated vertex), two triangles of zero area, a sliver below.
  mesh.triangles = {{0, 1, 2}, {1, 2, 0}, {0, 5, 2}, {0, 3, 1}, {0, 0, 2}, {0, 4, 1}};
  const auto hits_at = [](const Geometry& geometry, double x, double y) {
    return geometry.all_hits({Point3(x, y, 3), -Vec3::UnitZ()}).size();
  };
  TriangleMesh clean = mesh;
  remove_degenerate(clean);
  CHECK(clean.removed_degenerate == 2);
  CHECK(clean.triangles.size() == 4);
  CHECK(distinct_triangles(clean) == std::vector<int>{0, 3});
  for (const Geometry& geometry : {Geometry({surface_of(mesh)}), Geometry({surface_of(clean)})}) {
    CHECK(hits_at(geometry, 0.25, 0.25) == 1);
    CHECK(hits_at(geometry, 0.9, -0.1) == 0);
    CHECK(hits_at(geometry, 0.5, 0) == 1);  // on the edge between the triangle and the sliver
    CHECK(hits_at(geometry, 0.75, -5e-13) == 1);
    CHECK(hits_at(geometry, 0.75, -8e-13) == 0);
    const auto hit = geometry.first_hit({Point3(0.75, -5e-13, 3), -Vec3::UnitZ()});
    REQUIRE(hit);
    CHECK(hit->t == 3);
    CHECK(hit->normal == Vec3::UnitZ());
    CHECK((hit->position - Point3(0.75, -5e-13, 0)).norm() < epsilon);
  }
  // A card of two triangles back to back is entered and left at once.
  const Geometry card({surface_of(TriangleMesh{mesh.vertices, {{0, 1, 2}, {0, 2, 1}}, 0})});
  CHECK(card.all_hits({Point3(0.25, 0.25, 3), -Vec3::UnitZ()}).size() == 2);
}

}  // namespace geometry_watertight_test
