// Procedural shapes: numbers of vertices, closed, oriented, of the right size.
#include <catch2/catch.hpp>
#include <map>

#include "scene/base/error.h"
#include "scene/geometry/city.h"
#include "scene/geometry/round_shapes.h"
#include "scene/geometry/teapot.h"
#include "scene/scene.h"
#include "tests/scene/geometry_scenes.h"

namespace geometry_procedural_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

// Edges, by the places of their ends, that are not met once in either direction.
int open_edges(const TriangleMesh& mesh) {
  using Place = std::array<double, 3>;
  const auto place = [&](int v) { return Place{mesh.vertices[v][0], mesh.vertices[v][1], mesh.vertices[v][2]}; };
  std::map<std::pair<Place, Place>, int> uses;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const Place a = place(t[i]), b = place(t[(i + 1) % 3]);
      ++uses[{a, b}];
      --uses[{b, a}];
    }
  return int(std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second != 0; }));
}

}  // namespace

TEST_CASE("round shapes are closed, oriented and of the right volume", "[geometry]") {
  const TriangleMesh ball =
      make_displaced_sphere({.center = {1, 2, 3}, .radii = {1, 2, 3}, .around = 280, .rings = 278});
  CHECK(ball.vertices.size() == 77'840);
  CHECK(open_edges(ball) == 0);
  // An inscribed polyhedron: short by the order of the angle's square, (2 pi / 280)^2 = 5e-4.
  CHECK(volume(ball) == Approx(4 * pi / 3 * 6).epsilon(5e-4));
  const TriangleMesh face = make_displaced_sphere({.around = 40,
                                                   .rings = 30,
                                                   .waves = {{0.05, {5, 3, 1}, 0.4}},
                                                   .bumps = {{Vec3::UnitZ(), 0.3, -0.5}, {Vec3::UnitY(), 0.2, 1}}});
  CHECK(open_edges(face) == 0);
  CHECK(face.vertices[0].norm() == Approx(2 + 0.05 * std::sin(3.4)).epsilon(1e-3));  // the bump at the pole
  CHECK_THROWS_AS(make_displaced_sphere({.bumps = {{Vec3::UnitZ(), 0.3, -1.5}}}), Error);

  const TriangleMesh ring =
      make_torus({.axis = Vec3(1, 1, 0).normalized(), .radius = 2, .tube_radius = 0.5, .around = 96, .across = 64});
  CHECK(ring.vertices.size() == 6144);
  CHECK(open_edges(ring) == 0);
  // Both polygons are inscribed: areas by n/2 sin(2 pi/n), swept along chords.
  CHECK(volume(ring) == Approx(2 * pi * pi * 2 * 0.25).epsilon(4e-3));
  CHECK(volume(ring) > 0);
  CHECK_THROWS_AS(make_torus({.radius = 1, .tube_radius = 1}), Error);

  const TriangleMesh rod =
      make_tube({.path = {{1, 0, 0}, {1, 4, 3}}, .radius = 0.5, .end_radius = 0.5, .along = 24, .around = 16});
  CHECK(rod.vertices.size() == 384);
  CHECK(open_edges(rod) == 0);
  CHECK(volume(rod) == Approx(5 * 0.25 * 8 * std::sin(2 * pi / 16)).epsilon(1e-12));
  const TriangleMesh bent = make_tube({.path = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, 2, 1}},
                                       .radius = 0.1,
                                       .end_radius = 0.05,
                                       .along = 40,
                                       .around = 12});
  CHECK(open_edges(bent) == 0);
  CHECK(volume(bent) > 0);
  CHECK(open_edges(make_tube({.path = {{0, 0, 0}, {1, 0, 0}}, .caps = false})) > 0);
  CHECK_THROWS_AS(make_tube({.path = {{0, 0, 0}, {0, 0, 0}}}), Error);

  const TriangleMesh column = make_prism({.base = {3, 1, 2}, .sides = 107, .radius = 2, .top_radius = 2, .height = 5});
  CHECK(column.vertices.size() == 214);
  CHECK(open_edges(column) == 0);
  CHECK(volume(column) == Approx(5 * 4 * 53.5 * std::sin(2 * pi / 107)).epsilon(1e-12));
  CHECK_THROWS_AS(make_prism({.sides = 2}), Error);
}

TEST_CASE("the teapot is that of the published control points", "[geometry]") {
  const TriangleMesh teapot = make_teapot(16);
  CHECK(teapot.vertices.size() == 8192);
  Box bounds;
  for (const Point3& v : teapot.vertices) bounds = unite(bounds, {v, v});
  // Bottom and knob; the body's widest circle of 0.56 tangents; the tip of the spout, handle.
  CHECK(bounds.lo[1] == Approx(0).margin(1e-15));
  CHECK(bounds.hi[1] == Approx(3.15).epsilon(1e-15));
  CHECK(bounds.hi[2] == Approx(2).epsilon(1e-3));
  CHECK(bounds.lo[2] == Approx(-bounds.hi[2]).epsilon(1e-12));
  CHECK(bounds.hi[0] > 3.4);
  CHECK(bounds.hi[0] < 3.525);
  CHECK(bounds.lo[0] < -2.9);
  // Corners of patches are control points: rim and body meet on the circle (1.5, 2.4), body halves on (2, 0.9).
  const auto has = [&](const Point3& p) {
    return std::any_of(teapot.vertices.begin(), teapot.vertices.end(),
                       [&](const Point3& v) { return (v - p).norm() < 1e-14; });
  };
  for (const Point3& p : {Point3(1.5, 2.4, 0), Point3(0, 0.9, 2), Point3(-1.5, 0.15, 0), Point3(-3, 1.8, 0),
                          Point3(2.7, 2.4, 0), Point3(0, 0, 0)})
    CHECK(has(p));
  // Oriented: the signed volume of the open parts is nearly that of body, lid, handle and spout together.
  CHECK(volume(teapot) > 20);
  // Body and bottom alone are seen from outside.
  const Geometry geometry({surface_of(teapot)});
  for (const double phi : {0.7, 2.1, 3.9, 5.2}) {
    const Ray ray{Point3(9 * std::cos(phi), 1.2, 9 * std::sin(phi)), Vec3(-std::cos(phi), 0, -std::sin(phi))};
    const auto hit = geometry.first_hit(ray);
    REQUIRE(hit);
    CHECK(std::hypot(hit->position[0], hit->position[2]) == Approx(1.97).margin(0.06));
  }
  CHECK_THROWS_AS(make_teapot(1), Error);
}

TEST_CASE("the houses of a city stand on their lots", "[geometry]") {
  const City city{.boxes = 317,
                  .columns = 20,
                  .block = 4,
                  .lot = 12,
                  .street = 9,
                  .least_height = 4,
                  .greatest_height = 90,
                  .seed = 7};
  const TriangleMesh mesh = make_city(city);
  REQUIRE(mesh.vertices.size() == 317 * 24);
  REQUIRE(mesh.triangles.size() == 317 * 12);
  CHECK(open_edges(mesh) == 0);
  CHECK(volume(mesh) > 0);
  for (int n = 0; n < 317; ++n) {
    Box house;
    for (int v = 24 * n; v < 24 * (n + 1); ++v) house = unite(house, {mesh.vertices[v], mesh.vertices[v]});
    const double x = lot_begin(city, n % 20), z = lot_begin(city, n / 20);
    CHECK(Box{Point3(x, 0, z), Point3(x + 12, 90, z + 12)}.contains(house.lo));
    CHECK(Box{Point3(x, 4, z), Point3(x + 12, 90, z + 12)}.contains(house.hi));
    CHECK(house.size()[0] >= 0.7 * 12 - 1e-9);
  }
  CHECK(make_city(city).vertices == mesh.vertices);
  CHECK_THROWS_AS(make_city({.boxes = 0}), Error);
}

TEST_CASE("procedural shapes of a scene file", "[scene]") {
  const auto scene_with = [](const std::string& surface) {
    return parse_scene("[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n[[surface]]\n" + surface, "s.toml", ".");
  };
  const auto vertices = [&](const std::string& surface) {
    return std::get<TriangleMesh>(scene_with(surface).surfaces[0].shape).vertices.size();
  };
  CHECK(vertices(
            "type = \"displaced_sphere\"\nradius = 2\nsize = [12, 7]\nbumps = [{ direction = [0, 0, 2], width = 0.2, "
            "height = 0.1 }]\nwaves = [{ amplitude = 0.1, wave_vector = [1, 2, 3] }]") == 84);
  CHECK(vertices("type = \"torus\"\nradius = 2\ntube_radius = 0.5\nsize = [12, 7]") == 84);
  CHECK(vertices("type = \"tube\"\npath = [[0, 0, 0], [1, -2, 0]]\nradius = 0.5\nsize = [12, 7]") == 84);
  CHECK(vertices("type = \"prism\"\nsides = 9\nradius = 0.5\nheight = 2") == 18);
  CHECK(vertices("type = \"teapot\"\nsize = 4\ntransform = { scale = 0.5 }") == 512);
  CHECK(vertices("type = \"city\"\nboxes = 9\ncolumns = 3\nlot = 1\nstreet = 1\nheights = [1, 2]") == 216);
  const auto refused = [&](const std::string& surface, const std::string& says) {
    CHECK_THROWS_WITH(scene_with(surface), Catch::StartsWith("s.toml:") && Catch::Contains(says));
  };
  refused("type = \"teapott\"", "teapot");
  refused("type = \"teapot\"\nsize = 1", "size = 1");
  // Gigabytes and minutes, found by the fuzzer: a teapot of 64 million triangles.
  refused("type = \"teapot\"\nsize = 1000", "expected an integer from 2 to 256");
  refused("type = \"torus\"\nradius = 2\ntube_radius = 1\nsize = [4096, 4096]", "at most 2097152 vertices in all");
  refused("type = \"displaced_sphere\"\nradius = 2\nsize = [4096, 513]", "at most 2097152 vertices in all");
  refused("type = \"height_field\"\nsize = [2048, 1025]\nspacing = [1, 1]\nwaves = []", "at most 2097152 vertices");
  refused("type = \"torus\"\nradius = 2\ntube_radius = 2\nsize = [12, 7]", "tube_radius = 2");
  refused("type = \"tube\"\npath = [[0, 0, 0], [0, 0, 0]]\nradius = 0.5\nsize = [12, 7]", "points apart");
  refused("type = \"tube\"\npath = [[0, 0, 0]]\nradius = 0.5\nsize = [12, 7]", "at least 2 points");
  refused(
      "type = \"displaced_sphere\"\nradius = 2\nsize = [12, 7]\nwaves = [{ amplitude = 3, wave_vector = [9, 2, 3] }]",
      "share above 0");
  refused("type = \"prism\"\nsides = 2\nradius = 0.5\nheight = 2", "sides = 2");
  refused("type = \"city\"\nboxes = 9\ncolumns = 3\nlot = 1\nstreet = 1\nheights = [3, 2]", "[least, greatest]");
}

}  // namespace geometry_procedural_test
