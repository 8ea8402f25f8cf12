// Lit or not, by counting crossings of silhouettes along rays, against a shadow ray for every point.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/shadow_planes/shadow_volumes.h"
#include "scene/geometry/mesh_io.h"
#include "scene/geometry/shapes.h"
#include "tests/scene/geometry_scenes.h"

namespace counting_test {

using namespace airlight;
using namespace airlight::shadow_planes;

namespace {

struct Tally {
  int points = 0, lit = 0, left_out = 0, wrong = 0, counted = 0;
  std::string first;
};

double least_distance_to_planes(const ShadowVolumes& shadows, const Point3& x) {
  const Vec3 y = x - shadows.light();
  double least = infinity;
  for (const SilhouetteEdge& edge : shadows.edges()) {
    const Vec3 normal = edge.a.cross(edge.b);
    if (normal.norm() > 0) least = std::min(least, std::abs(y.dot(normal)) / normal.norm());
  }
  return least;
}

// Triangles between the light and a point, from there: not the way in which the method counts.
int triangles_towards(const scene::Scene& scene, const Point3& x, const Point3& light) {
  const Vec3 offset = light - x;
  int count = 0;
  for (const scene::Hit& hit : scene.geometry->all_hits({x, offset.normalized()}, offset.norm()))
    count += hit.triangle >= 0;
  return count;
}

// Points on random rays that start anywhere in the box, up to what ends them: lit by the intervals if nothing is in the
// way of the light, and behind as many triangles as the crossings sum up to. Points within 1e-5 of the size from an
// edge's plane are left out. `beside`: where a light that lies on a surface is moved to for the shadow rays.
void compare(const std::vector<scene::Surface>& surfaces, const Point3& light, const Box& box, int rays, int per_ray,
             unsigned seed, Tally& tally, const Vec3& beside = Vec3::Zero()) {
  auto scene = std::make_shared<scene::Scene>();
  scene->surfaces = surfaces;
  finish(*scene);
  const bool all_triangles = std::all_of(surfaces.begin(), surfaces.end(), [](const scene::Surface& s) {
    return std::holds_alternative<scene::TriangleMesh>(s.shape);
  });
  const ShadowVolumes shadows(std::make_shared<Occluders>(scene), light);
  scene::Random random{std::mt19937_64(seed)};
  const double size = box.size().norm();
  std::vector<Crossing> crossings;
  std::vector<ShadowVolumes::Interval> lit;
  for (int i = 0; i < rays; ++i) {
    const Ray ray{random.in(box), random.direction()};
    const auto hit = scene->geometry->first_hit(ray);
    const double end = hit ? hit->t : size;
    const int at_origin = shadows.count(ray.origin);
    shadows.lit_parts(ray, end, at_origin, nullptr, crossings, lit);
    for (int k = 0; k < per_ray; ++k) {
      const double t = random.uniform(0, end);
      const Vec3 offset = ray.at(t) - (light + beside);
      const bool expected = !scene->geometry->occluded({light + beside, offset.normalized()}, offset.norm());
      bool got = false;
      for (const auto& part : lit) got = got || (part.begin < t && t < part.end);
      ++tally.points;
      tally.lit += expected;
      int m = at_origin;
      for (const Crossing& crossing : crossings) m += crossing.x < t ? crossing.change : 0;
      const bool counts = all_triangles && beside == Vec3::Zero();
      tally.counted += counts;
      if (got == expected && (!counts || m == triangles_towards(*scene, ray.at(t), light))) continue;
      if (least_distance_to_planes(shadows, ray.at(t)) < 1e-5 * size) {
        ++tally.left_out;
      } else if (tally.wrong++ == 0) {
        tally.first = fmt::format("seed {}, ray {}, t = {}: {}, expected {}", seed, i, t, got, expected);
      }
    }
  }
}

std::vector<scene::Surface> mesh_of(const std::string& name) {
  return {{name, scene::read_mesh(AIRLIGHT_SOURCE_DIR "/experiments/data/" + name), scene::Lambert{}}};
}

Box around(const std::vector<scene::Surface>& surfaces) {
  const Box box = scene::Geometry(surfaces).bounds();
  return {box.lo - 0.5 * box.size(), box.hi + 0.5 * box.size()};
}

}  // namespace

TEST_CASE("shadow planes: counting on real meshes is brute force", "[shadow_planes]") {
  Tally tally;
  for (const char* name : {"elephant.off", "knot1.off"}) {
    const std::vector<scene::Surface> surfaces = mesh_of(name);
    const Box box = around(surfaces);
    const Point3 middle = 0.5 * (box.lo + box.hi);
    // Beside it, above, and inside.
    for (const Vec3& place : {Vec3(0.4, 0.3, 0.2), Vec3(0.01, 0.49, 0.02), Vec3(0.02, 0.03, -0.01)})
      compare(surfaces, middle + Vec3(place.array() * box.size().array()), box, 400, 25, 7, tally);
  }
  CAPTURE(tally.points, tally.lit, tally.left_out, tally.wrong, tally.first);
  CHECK(tally.wrong == 0);
  CHECK(tally.left_out < 0.0005 * tally.points);
  CHECK(tally.counted == tally.points);
  CHECK((tally.lit > 0.2 * tally.points && tally.lit < 0.8 * tally.points));
}

// Closed boxes that cut one another, some turned inside out, some with faces missing, some there twice; lights and
// cameras anywhere, in walls too.
TEST_CASE("shadow planes: counting in soups of boxes is brute force", "[shadow_planes]") {
  Tally tally;
  for (unsigned seed = 0; seed < 40; ++seed) {
    scene::Random random{std::mt19937_64(seed)};
    std::vector<scene::Surface> surfaces;
    for (int i = 0; i < 8; ++i) {
      const Point3 corner = random.in({{-1, -1, -1}, {1, 1, 1}});
      scene::TriangleMesh box = scene::make_box({corner, corner + random.in({{0.1, 0.1, 0.1}, {0.8, 0.8, 0.8}})});
      if (seed % 4 == 1)
        for (auto& t : box.triangles) std::swap(t[0], t[1]);
      if (seed % 4 == 2) box.triangles.resize(7);
      if (seed % 4 == 3 && i > 0) box = std::get<scene::TriangleMesh>(surfaces[0].shape);
      surfaces.push_back({"box", box, scene::Lambert{}});
    }
    if (seed % 5 == 0) surfaces.push_back({"ball", scene::Sphere{{0.2, -0.3, 0.4}, 0.5}, scene::Lambert{}});
    if (seed % 5 == 1) surfaces.push_back({"floor", scene::Plane{{0, -0.8, 0}, {0, 1, 0}}, scene::Lambert{}});
    const Box space{{-2, -2, -2}, {2, 2, 2}};
    if (seed % 7 != 0) {
      compare(surfaces, random.in(space), space, 100, 25, seed, tally);
      continue;
    }
    // In a wall: it shines to one side, whichever.
    const auto& box = std::get<scene::TriangleMesh>(surfaces[0].shape);
    const Vec3 u = box.vertices[1] - box.vertices[0], v = box.vertices[2] - box.vertices[0];
    Tally to_either[2] = {tally, tally};
    for (const int side : {0, 1})
      compare(surfaces, box.vertices[0] + 0.3 * u + 0.4 * v, space, 100, 25, seed, to_either[side],
              (side == 0 ? 1e-7 : -1e-7) * u.cross(v).normalized());
    tally = to_either[0].wrong < to_either[1].wrong ? to_either[0] : to_either[1];
  }
  CAPTURE(tally.points, tally.lit, tally.left_out, tally.wrong, tally.first);
  CHECK(tally.wrong == 0);
  CHECK(tally.left_out < 0.01 * tally.points);
  CHECK(tally.counted > 0.5 * tally.points);
  CHECK((tally.lit > 0.1 * tally.points && tally.lit < 0.9 * tally.points));
}

TEST_CASE("shadow planes: triangles without area and seams cast no shadow of their own", "[shadow_planes]") {
  scene::TriangleMesh box = scene::make_box({{-1, -1, -1}, {1, 1, 1}});
  scene::TriangleMesh apart;  // every triangle with vertices of its own
  for (const auto& t : box.triangles) {
    const int first = int(apart.vertices.size());
    for (const int v : t) apart.vertices.push_back(box.vertices[v]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  apart.triangles.push_back(apart.triangles.front());
  apart.triangles.push_back({0, 1, 1});
  const MeshEdges whole(box), seams(apart);
  CHECK(whole.edges().size() == 18);
  CHECK(seams.edges().size() == 18);
  for (const Point3& light : {Point3(3, 2, 1), Point3(0, 0, 5), Point3(0.1, 0.2, 0.3), Point3(1, 3, 0)})
    CHECK(silhouette(whole, light).size() == silhouette(seams, light).size());
  CHECK(silhouette(whole, {3, 4, 5}).size() == 6);
  for (const SilhouetteEdge& edge : silhouette(whole, {3, 4, 5})) CHECK(edge.multiplicity == 2);
  CHECK(silhouette(whole, {0.1, 0.2, 0.3}).empty());  // from inside there is none
}

}  // namespace counting_test
