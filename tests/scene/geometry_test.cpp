#include "scene/geometry/geometry.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>
#include <thread>

#include "scene/error.h"
#include "scene/geometry/clean_mesh.h"
#include "scene/geometry/ray_primitive.h"
#include "scene/geometry/shapes.h"

using namespace airlight;
using namespace airlight::scene;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Random {
  std::mt19937_64 engine{3};
  double uniform(double lo = 0, double hi = 1) { return std::uniform_real_distribution<double>(lo, hi)(engine); }
  Vec3 direction() {
    for (;;) {
      const Vec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }
  Point3 in(const Box& box) {
    return {uniform(box.lo[0], box.hi[0]), uniform(box.lo[1], box.hi[1]), uniform(box.lo[2], box.hi[2])};
  }
};

// A closed mesh with concavities and shared vertices: a torus.
TriangleMesh torus(int n, int m) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      const double a = 2 * pi * i / n, b = 2 * pi * k / m, r = 1 + 0.4 * std::cos(b);
      mesh.vertices.emplace_back(r * std::cos(a), 0.4 * std::sin(b), -r * std::sin(a));
    }
  const auto at = [&](int i, int k) { return (i % n) * m + k % m; };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  return sum;
}

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& shift) {
  for (Point3& v : mesh.vertices) v = scale * v + shift;
  return mesh;
}

Surface surface_of(Shape shape) { return {"thing", std::move(shape), Lambert{}}; }

// Rays that look for trouble: at vertices, along edges, through edge midpoints, along the axes, and at random.
std::vector<Ray> hard_rays(const TriangleMesh& mesh, const Box& around, int count, Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const auto& t = mesh.triangles[random.engine() % mesh.triangles.size()];
    const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]];
    const Point3 origin = random.in(around);
    rays.push_back({origin, (a - origin).normalized()});
    rays.push_back({origin, (0.5 * (a + b) - origin).normalized()});
    rays.push_back({a + 20 * (a - b), (b - a).normalized()});
    for (int axis = 0; axis < 3; ++axis) {  // exactly through a vertex
      Ray ray{a, Vec3::Unit(axis)};
      ray.origin[axis] = -8;
      rays.push_back(ray);
    }
    rays.push_back({origin, random.direction()});
  }
  return rays;
}

// All triangles, one by one, without the tree.
std::vector<Crossing> brute_force(const TriangleMesh& mesh, const Ray& ray) {
  const ShearedRay sheared(ray);
  std::vector<Crossing> crossings;
  for (const auto& t : mesh.triangles) {
    Crossing crossing;
    if (cross_triangle(sheared, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], crossing))
      crossings.push_back(crossing);
  }
  std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return crossings;
}

bool same_bits(const Hit& a, const Hit& b) {
  return a.t == b.t && a.position == b.position && a.normal == b.normal && a.surface == b.surface;
}

}  // namespace

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
        const Hit scaled{a[k].t * scale, a[k].position * scale, a[k].normal, a[k].surface};
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

TEST_CASE("a point moved off its surface does not see it again", "[geometry]") {
  Random random;
  for (const double where : {0.0, 1.0, 1e6}) {
    const Vec3 shift(where, -where, where);
    const Sphere ball{Point3(0.5, 0.25, -0.125) + shift, 0.7};
    const TriangleMesh mesh = moved(make_box({Point3(-1, -1, -1), Point3(1, 1, 1)}), 1, shift);
    // The same box turned: no coordinate is exact.
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
  // The same triangle three times (rotated, over a repeated vertex), two of zero area, a sliver below.
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
