// The airbrush: particles stay inside closed surfaces, bounce as mirrors do, and diffuse as they should.
#include "methods/fogshop/authoring/airbrush.h"

#include <catch2/catch.hpp>

#include "scene/geometry/mesh_io.h"
#include "scene/geometry/shapes.h"

namespace airbrush_test {

using namespace airlight;
using namespace airlight::fogshop::authoring;

TEST_CASE("a particle is mirrored at a wall", "[fogshop][authoring]") {
  const scene::Geometry floor({{"floor", scene::Plane{}, {}}});
  // From height 1, 3 down and 4 across: it meets the floor after a third of the way.
  const Flight flight = bounce(&floor, {0, 1, 0}, {4, -3, 0}, {4, -3, 0});
  // It turns `clearance` above the floor.
  CHECK(flight.position.isApprox(Point3(4, 2 + 2 * clearance, 0), 1e-12));
  CHECK(flight.velocity.isApprox(Vec3(4, 3, 0), 1e-15));
  const Flight free = bounce(nullptr, {0, 1, 0}, {4, -3, 0}, {4, -3, 0});
  CHECK(free.position == Point3(4, -2, 0));
  // One that ends just above the floor is kept off it.
  CHECK(bounce(&floor, {0, 1, 0}, {0, -1 + 1e-9, 0}, {0, -1, 0}).position[1] >= clearance);
  // One that starts within the clearance may leave, and cannot pass.
  CHECK(bounce(&floor, {0, 1e-12, 0}, {0, -5, 0}, {0, -1, 0}).position[1] == Approx(5));
  CHECK(bounce(&floor, {0, 1e-12, 0}, {0, 2, 0}, {0, 1, 0}).position[1] == Approx(2));
}

TEST_CASE("1e5 airbrush steps stay inside a closed box", "[fogshop][authoring]") {
  const Box box{Point3(-1, -0.5, -0.2), Point3(1, 0.5, 0.2)};
  const scene::Geometry geometry({{"box", scene::make_box(box), {}}});
  GaussianList list;
  Airbrush op;
  op.position = {0.9, 0.4, 0.1};
  op.speed = 3;
  op.diffusion = 1.5;
  op.dt = 0.1;
  op.brush = {.a = 5, .c = 1};
  // Twenty particles over 1e4 steps: 1e5 moves between them.
  op.steps = 10'000;
  op.rate = 20 / (op.steps * op.dt);
  list.begin();
  const auto ids = airbrush(list, op, &geometry);
  REQUIRE(ids.size() == 20);
  for (const auto& g : list.all()) CHECK(box.contains(g.b));
  // All of 1e5 single steps of one particle, looked at one by one; kicks are ten times the thinnest side.
  Point3 x = op.position;
  Vec3 v(3, 2, -1);
  std::size_t out = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double u = std::sin(1.7 * i), w = std::sin(2.3 * i + 1), s = std::sin(3.1 * i + 2);
    const Flight flight = bounce(&geometry, x, v * 0.1 + 2 * Vec3(u, w, s), v);
    x = flight.position;
    v = flight.velocity;
    out += !box.contains(x);
  }
  CHECK(out == 0);
  CHECK(v.norm() == Approx(Vec3(3, 2, -1).norm()).epsilon(1e-9));
}

TEST_CASE("airbrushed fog fills a real mesh and stays in it", "[fogshop][authoring]") {
  const scene::Surface blobby{"blobby", scene::read_mesh(AIRLIGHT_SOURCE_DIR "/experiments/data/blobby.off"), {}};
  const scene::Geometry geometry({blobby});
  const Box bounds = geometry.bounds();
  const double size = bounds.size().norm();
  // Somewhere inside: the middle of the first pair of crossings of a line through the centre.
  const auto hits = geometry.all_hits({bounds.center() - size * Vec3::UnitX(), Vec3::UnitX()});
  REQUIRE(hits.size() >= 2);
  Airbrush op;
  op.position = 0.5 * (hits[0].position + hits[1].position);
  op.rate = 40;
  op.dt = 0.05;
  op.steps = 200;
  op.speed = 0.1 * size;
  op.diffusion = 0.2 * size;
  op.brush = {.a = 10 / size, .c = 1};
  op.seed = 5;
  GaussianList list;
  list.begin();
  const auto ids = airbrush(list, op, &geometry);
  CHECK(ids.size() == 400);
  // An odd number of crossings in any direction: inside.
  for (const auto& g : list.all()) CHECK(geometry.all_hits({g.b, Vec3(0.3, 0.5, -0.8).normalized()}).size() % 2 == 1);
  list.begin();
  CHECK(freeze(list).size() == 400);
  const auto frozen = list.all();
  list.begin();
  op.seed = 6;
  CHECK(airbrush(list, op, &geometry).size() == 400);  // the frozen do not move
  CHECK(std::equal(frozen.begin(), frozen.end(), list.all().begin()));
  // Without freezing they go on.
  list.begin();
  CHECK(airbrush(list, op, &geometry).size() == 800);
}

TEST_CASE("an airbrush in free air diffuses as Brownian motion", "[fogshop][authoring]") {
  Airbrush op;
  op.rate = 2000;
  op.dt = 0.02;
  op.steps = 100;
  op.diffusion = 0.5;
  op.brush = {.a = 5, .c = 1};
  GaussianList list, again;
  list.begin();
  again.begin();
  airbrush(list, op, nullptr);
  airbrush(again, op, nullptr);
  CHECK(list.all() == again.all());
  REQUIRE(list.all().size() == 4000);
  // Age of particle k is T - k/rate; E |x|^2 = 3 diffusion^2 age, with the variance 6 diffusion^4 age^2.
  double found = 0, expected = 0, variance = 0;
  for (std::size_t k = 0; k < 4000; ++k) {
    const double age = 2 - double(k) / 2000;
    found += list.all()[k].b.squaredNorm();
    expected += 3 * 0.25 * age;
    variance += 6 * 0.0625 * age * age;
  }
  CHECK(std::abs(found - expected) < 4 * std::sqrt(variance));
}

}  // namespace airbrush_test
