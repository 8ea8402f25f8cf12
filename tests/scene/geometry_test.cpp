#include "scene/geometry/geometry.h"

#include <catch2/catch.hpp>
#include <thread>

#include "scene/base/error.h"
#include "scene/geometry/shapes.h"
#include "tests/scene/geometry_scenes.h"

namespace geometry_test {

using namespace airlight;
using namespace airlight::scene;

TEST_CASE("positions lie on the surface and normals face the origin", "[geometry]") {
  Random random;
  const Sphere sphere{Point3(0.3, -2, 5), 1.7};
  const Plane plane{Point3(1, -4, 0), Vec3(0.1, 1, -0.2).normalized()};
  const TriangleMesh mesh = torus(40, 24);
  const Geometry geometry({surface_of(mesh), surface_of(sphere), surface_of(plane)});
  int seen[3] = {0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    const Ray ray{random.in({Point3(-3, -3, -3), Point3(3, 3, 8)}), random.direction()};
    double last = 0;
    for (const Hit& hit : geometry.all_hits(ray)) {
      ++seen[hit.surface];
      CHECK(hit.t >= last);
      last = hit.t;
      REQUIRE(std::abs(hit.normal.norm() - 1) < 4 * epsilon);
      REQUIRE(hit.normal.dot(ray.direction) <= 1e-12);
      // t is known to the rounding of the coordinates (10 m) divided by the cosine of incidence.
      const double cosine = -hit.normal.dot(ray.direction);
      if (cosine > 1e-3) REQUIRE((hit.position - ray.at(hit.t)).norm() < 64 * epsilon * (10 + hit.t) / cosine);
      if (hit.surface == 1) REQUIRE(std::abs((hit.position - sphere.center).norm() - sphere.radius) < 8 * epsilon * 10);
      if (hit.surface == 2)
        REQUIRE(std::abs(plane.normal.dot(hit.position - plane.point)) < 8 * epsilon * (10 + hit.t));
    }
  }
  for (const int n : seen) CHECK(n > 1000);
  CHECK(geometry.bounds().hi[2] == Approx(6.7));
}

// Closed forms: the unit box along an axis, a sphere off axis (chord 2 sqrt(r^2 - b^2)), a plane at 45 degrees.
TEST_CASE("hits of simple shapes are where they must be", "[geometry]") {
  const Geometry box({surface_of(make_box({Point3(-1, -1, -1), Point3(1, 1, 1)}))});
  const Ray ray{Point3(0.25, 0.125, 5), -Vec3::UnitZ()};
  const auto hits = box.all_hits(ray);
  REQUIRE(hits.size() == 2);
  CHECK(hits[0].t == 4);
  CHECK(hits[1].t == 6);
  CHECK(hits[0].normal == Vec3::UnitZ());
  CHECK(hits[1].normal == Vec3::UnitZ());  // seen from inside

  const Geometry sphere({surface_of(Sphere{Point3(0, 0.6, 0), 1})});
  const auto chord = sphere.all_hits({Point3(0, 0, 10), -Vec3::UnitZ()});
  REQUIRE(chord.size() == 2);
  CHECK(chord[0].t == Approx(10 - 0.8).epsilon(1e-15));
  CHECK(chord[1].t == Approx(10 + 0.8).epsilon(1e-15));
  CHECK(chord[0].normal.isApprox(Vec3(0, -0.6, 0.8), 1e-14));
  CHECK_FALSE(sphere.occluded({Point3(0, -0.4, 10), -Vec3::UnitZ()}));  // a tangent does not cross
  CHECK(sphere.all_hits({Point3(0, 0.6, 0), Vec3::UnitX()}).size() == 1);

  const Geometry plane({surface_of(Plane{})});
  const auto hit = plane.first_hit({Point3(0, 1, 0), Vec3(1, -1, 0).normalized()});
  REQUIRE(hit);
  CHECK(hit->t == Approx(std::sqrt(2.0)).epsilon(1e-15));
  CHECK(hit->position.isApprox(Point3(1, 0, 0), 1e-15));
  CHECK_FALSE(plane.first_hit({Point3(0, 1, 0), Vec3::UnitX()}));
  CHECK_FALSE(plane.first_hit({Point3(0, 1, 0), Vec3::UnitY()}));
  CHECK(plane.first_hit({Point3(0, 1, 0), Vec3(1, -1e-12, 0)})->t == Approx(1e12));
}

TEST_CASE("a scene scaled by a power of two gives the same bits", "[geometry]") {
  Random random;
  const Sphere ball{Point3(1, 1, 1), 0.3};
  const Plane ground{Point3(0, -0.75, 0), Vec3(0.1, 1, -0.2).normalized()};
  for (const double scale : {std::ldexp(1.0, -20), 0.5, 8.0, std::ldexp(1.0, 30)}) {
    const TriangleMesh mesh = torus(20, 12);
    const Geometry one({surface_of(mesh), surface_of(ball), surface_of(ground)});
    const Geometry other({surface_of(moved(mesh, scale, Vec3::Zero())),
                          surface_of(Sphere{scale * ball.center, scale * ball.radius}),
                          surface_of(Plane{scale * ground.point, ground.normal})});
    for (int i = 0; i < 5000; ++i) {
      const Ray ray{random.in({Point3::Constant(-2), Point3::Constant(2)}), random.direction()};
      const auto a = one.all_hits(ray), b = other.all_hits({scale * ray.origin, ray.direction});
      REQUIRE(a.size() == b.size());
      for (std::size_t k = 0; k < a.size(); ++k) {
        const Hit scaled{a[k].t * scale, a[k].position * scale, a[k].normal, a[k].surface, a[k].triangle};
        REQUIRE(same_bits(scaled, b[k]));
        const Point3 moved_off = one.offset_origin(a[k].position, a[k].normal, ray.direction);
        REQUIRE(other.offset_origin(b[k].position, b[k].normal, ray.direction) == scale * moved_off);
      }
    }
  }
}

// At 1e6 m from the origin coordinates are rounded to 1.2e-10 m: hits of the moved scene agree to that, divided by the
// cosine of incidence.
TEST_CASE("a scene far from the origin, and an origin far from the scene", "[geometry]") {
  Random random;
  const TriangleMesh mesh = torus(40, 24);
  const Geometry here({surface_of(mesh)});
  const Vec3 shift(1e6, -1e6, 1e6);
  const Geometry there({surface_of(moved(mesh, 1, shift))});
  int compared = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ray ray{random.in({Point3::Constant(-2), Point3::Constant(2)}), random.direction()};
    const Ray far{ray.origin + shift, ray.direction};
    const auto a = here.first_hit(ray), b = there.first_hit(far);
    if (!a || !b) continue;
    const double cosine = -a->normal.dot(ray.direction);
    if (cosine < 0.1 || std::abs(a->t - b->t) > 1e-3) continue;  // another sheet, past a silhouette
    ++compared;
    REQUIRE(std::abs(a->t - b->t) < 1e-9 / cosine);
    REQUIRE((b->position - shift - a->position).norm() < 2e-9 / cosine);
  }
  CHECK(compared > 500);

  // A ray of 1e7 m is off by 1e7 * 2^-53 = 1e-9 m where it arrives.
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point3 target = 0.999 * mesh.vertices[random.engine() % mesh.vertices.size()];
    const Vec3 away = random.direction();
    const Ray ray{target + 1e7 * away, -away};
    const auto hits = here.all_hits(ray);
    REQUIRE(hits.size() % 2 == 0);
    for (const Hit& hit : hits) {
      ++found;
      REQUIRE((hit.position - (target + (1e7 - hit.t) * away)).norm() < 1e-7);
    }
  }
  CHECK(found > 2000);
}

TEST_CASE("coincident surfaces: the first in the list is hit", "[geometry]") {
  const TriangleMesh box = make_box({Point3(-1, -1, -1), Point3(1, 1, 1)});
  const Plane top{Point3(0, 1, 0), Vec3::UnitY()};
  const Ray down{Point3(0.3, 4, 0.2), -Vec3::UnitY()};
  CHECK(Geometry({surface_of(box), surface_of(top)}).first_hit(down)->surface == 0);
  CHECK(Geometry({surface_of(top), surface_of(box)}).first_hit(down)->surface == 0);
  CHECK(Geometry({surface_of(box), surface_of(box)}).first_hit(down)->surface == 0);
}

TEST_CASE("odd rays and odd scenes give answers", "[geometry]") {
  const double nan = std::nan("");
  const Geometry geometry({surface_of(torus(10, 8)), surface_of(Plane{Point3(0, -3, 0), Vec3::UnitY()})});
  CHECK_FALSE(geometry.first_hit({Point3(nan, 0, 0), Vec3::UnitX()}));
  CHECK_FALSE(geometry.first_hit({Point3(0, 0, 0), Vec3::Zero()}));
  CHECK_FALSE(geometry.first_hit({Point3(0, 0, 0), Vec3(nan, nan, nan)}));
  CHECK_FALSE(geometry.occluded({Point3(0, 9, 0), -Vec3::UnitY()}, -1));
  CHECK_FALSE(geometry.occluded({Point3(0, 9, 0), -Vec3::UnitY()}, 0));
  CHECK(geometry.occluded({Point3(0, 9, 0), -Vec3::UnitY()}, 12.5));

  const Geometry plane_only({surface_of(Plane{})});
  CHECK(plane_only.bounds().empty());
  const Geometry flat({surface_of(TriangleMesh{{Point3(0, 0, 0), Point3(1, 0, 0), Point3(0, 0, 1)}, {{0, 2, 1}}, 0})});
  CHECK(flat.first_hit({Point3(0.25, 1, 0.25), -Vec3::UnitY()})->t == 1);
  const Geometry nothing({surface_of(TriangleMesh{})});
  CHECK_FALSE(nothing.first_hit({Point3(0, 0, 0), Vec3::UnitX()}));
  // One huge and one tiny thing: the tree's widening is larger than the tiny one, the answer is still exact.
  const Geometry mixed(
      {surface_of(Sphere{Point3(0, -1e9, 0), 1e9 - 1}), surface_of(moved(torus(10, 8), 1e-3, Vec3::Zero()))});
  CHECK(mixed.first_hit({Point3(0.001, 1, 0), -Vec3::UnitY()})->t == Approx(1 - 0.4e-3).epsilon(1e-6));
  CHECK(mixed.first_hit({Point3(0.5, 1, 0), -Vec3::UnitY()})->t == Approx(2).epsilon(1e-6));

  TriangleMesh bad = torus(10, 8);
  bad.vertices[3][1] = nan;
  CHECK_THROWS_WITH(Geometry({surface_of(bad)}), "surface 'thing': vertex 3 is not finite");
  bad = torus(10, 8);
  bad.triangles[7][2] = 80;
  CHECK_THROWS_WITH(Geometry({surface_of(bad)}), "surface 'thing': triangle 7 has vertex 80, expected 0 to 79");
  CHECK_THROWS_AS(Geometry({surface_of(Sphere{Point3::Zero(), -1})}), Error);
  CHECK_THROWS_AS(Geometry({surface_of(Plane{Point3::Zero(), Vec3(0, 2, 0)})}), Error);
}

TEST_CASE("threads get the same hits", "[geometry]") {
  const Geometry geometry({surface_of(torus(60, 40)), surface_of(Sphere{Point3(0, 0, 0), 0.3})});
  const auto trace = [&](std::vector<Hit>& hits) {
    Random random;
    for (int i = 0; i < 20000; ++i) {
      const Ray ray{random.in({Point3::Constant(-2), Point3::Constant(2)}), random.direction()};
      if (const auto hit = geometry.first_hit(ray)) hits.push_back(*hit);
    }
  };
  std::vector<Hit> a, b;
  std::thread first([&] { trace(a); }), second([&] { trace(b); });
  first.join();
  second.join();
  REQUIRE(a.size() == b.size());
  CHECK(a.size() > 2000);
  CHECK(std::equal(a.begin(), a.end(), b.begin(), same_bits));
}

}  // namespace geometry_test
