// Forces that are gradients move nothing: uniform ones, and weight that depends on the height alone.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/geometry/shapes.h"
#include "tests/reference/stable_fluids/problems.h"

namespace rest_test {

using namespace airlight;
using namespace airlight::stable_fluids;
using testing::box_problem;
using testing::Kind;
using testing::start;

namespace {

double speed_after(const scene::FlowProblem& problem, std::map<std::string, std::string> settings, int steps = 12,
                   double dt = 0.0625) {
  const auto flow = start(problem, std::move(settings));
  double most = 0;
  for (int step = 0; step < steps; ++step) {
    flow->step(dt);
    most = std::max(most, flow->totals().greatest_speed);
  }
  return most;
}

scene::FlowProblem around_a_ball(int dimensions, Kind sides = Kind::free_slip) {
  scene::FlowProblem problem = box_problem(dimensions, Vec3(1, 1, 1), sides);
  problem.obstacles = {{"ball", scene::Sphere{Point3(0.45, 0.55, dimensions == 2 ? 0 : 0.5), 0.27}, {}}};
  problem.gravity = Vec3(0, -9.81, 0);
  return problem;
}

scene::Push everywhere(const Vec3& acceleration) {
  scene::Push push;
  push.acceleration = acceleration;
  return push;
}

}  // namespace

TEST_CASE("stable fluids: uniform forces move nothing in a closed box around a ball", "[stable_fluids]") {
  const int dimensions = GENERATE(2, 3);
  for (const char* precision : {"float", "double"})
    for (const Kind sides : {Kind::free_slip, Kind::no_slip}) {
      scene::FlowProblem problem = around_a_ball(dimensions, sides);
      problem.viscosity = sides == Kind::no_slip ? 0.01 : 0;
      problem.weight = 0.5;
      problem.density = 0.7;
      CHECK(speed_after(problem, {{"precision", precision}}) == 0);
      problem.gravity = Vec3(3, -7, 1);  // along no axis
      CHECK(speed_after(problem, {{"precision", precision}}) == 0);
      problem = around_a_ball(dimensions, sides);
      problem.expansion = 0.0033;
      problem.temperature = 150;
      problem.confinement = 0.5;
      CHECK(speed_after(problem, {{"precision", precision}}) == 0);
      problem.pushes = {everywhere(Vec3(0.3, 2, -0.1)), everywhere(Vec3(40, 0, 0))};
      problem.pushes[1].frequency = 3;
      CHECK(speed_after(problem, {{"precision", precision}}) == 0);
    }
}

TEST_CASE("stable fluids: layers of smoke stay where they are, around a ball and without one", "[stable_fluids]") {
  const int dimensions = GENERATE(2, 3);
  for (const char* precision : {"float", "double"})
    for (const bool obstacle : {false, true}) {
      scene::FlowProblem problem = around_a_ball(dimensions);
      if (!obstacle) problem.obstacles.clear();
      problem.weight = 5;
      problem.wave = scene::Wave{Vec3(0, 1, 0), 1, 2, 0.3};
      CHECK(speed_after(problem, {{"precision", precision}}) == 0);
      // A push that depends on the height alone, too.
      problem.pushes = {everywhere(Vec3(0, 8, 0))};
      problem.pushes[0].region = Box{Point3(-1, 0.3, -1), Point3(2, 0.7, 2)};
      CHECK(speed_after(problem, {{"precision", precision}}) == 0);
    }
}

TEST_CASE("stable fluids: each of two rooms keeps its own warmth, at rest", "[stable_fluids]") {
  scene::FlowProblem problem = around_a_ball(3);
  problem.obstacles.push_back({"wall", scene::make_box({Point3(0.8, -1, -1), Point3(0.87, 2, 2)}), {}});
  problem.expansion = 0.0033;
  problem.temperature = 20;
  scene::Source source;
  source.region = Box{Point3(0.87, -1, -1), Point3(2, 2, 2)};
  source.temperature = 300;
  problem.sources.push_back(source);
  CHECK(speed_after(problem, {{"precision", "float"}}) == 0);
}

TEST_CASE("stable fluids: a box with an open top is at rest under a uniform weight", "[stable_fluids]") {
  const int dimensions = GENERATE(2, 3);
  scene::FlowProblem problem = around_a_ball(dimensions);
  problem.sides[1][1].kind = Kind::open;
  problem.pushes = {everywhere(Vec3(0, -4.9, 0))};
  CHECK(speed_after(problem, {{"precision", "float"}}) == 0);
  // The open end of an axis that the force does not follow lets the fluid out: the pressure outside is 0 at any height.
  problem.sides[1][1].kind = Kind::free_slip;
  problem.sides[0][1].kind = Kind::open;
  CHECK(speed_after(problem, {{"precision", "float"}}) > 0.1);
}

TEST_CASE("stable fluids: a uniform force accelerates a periodic box, unless a wall stands across it",
          "[stable_fluids]") {
  const int dimensions = GENERATE(2, 3);
  scene::FlowProblem problem = box_problem(dimensions, Vec3(1, 1, 1), Kind::periodic);
  problem.pushes = {everywhere(Vec3(0.25, -0.5, 0))};
  const auto flow = start(problem, {});
  testing::run(*flow, 16, 0.0625);
  CHECK(std::abs(flow->velocity(Point3(0.3, 0.2, 0.1))[0] - 0.25) < 1e-12);  // a t, t = 1 s
  CHECK(std::abs(flow->velocity(Point3(0.8, 0.9, 0.4))[1] + 0.5) < 1e-12);

  problem.pushes = {everywhere(Vec3(0, -9.81, 0))};
  problem.viscosity = 0.01;
  problem.obstacles = {{"ball", scene::Sphere{Point3(0.45, 0.55, dimensions == 2 ? 0 : 0.5), 0.27}, {}},
                       {"floor", scene::make_box({Point3(-1, 0.1, -1), Point3(2, 0.2, 2)}), {}}};
  CHECK(speed_after(problem, {}) == 0);
  problem.obstacles.pop_back();
  CHECK(speed_after(problem, {}) > 1);
}

// A flow between plates under a uniform force: u = a / (2 nu) y (1 - y), whatever order the parts of a step have.
TEST_CASE("stable fluids: a force along a periodic channel ends in Poiseuille's parabola", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::no_slip);
  problem.sides[0][0].kind = problem.sides[0][1].kind = Kind::periodic;
  problem.viscosity = 1;
  problem.pushes = {everywhere(Vec3(0.8, 0, 0))};
  const auto flow = start(problem, {{"n", "32"}});
  testing::run(*flow, 60, 0.25);
  for (const double y : {0.109375, 0.515625}) {
    const double exact = 0.4 * y * (1 - y);
    CHECK(std::abs(flow->velocity(Point3(0.3, y, 0))[0] - exact) < 0.8 / 8 / 32 / 32 * 1.01);  // h^2 a / (8 nu)
  }
}

// A heavy layer's remainder: what a blob does on top of an even warmth does not depend on this warmth.
TEST_CASE("stable fluids: an even warmth changes nothing of what a warm blob does", "[stable_fluids]") {
  scene::FlowProblem cold = around_a_ball(3);
  cold.expansion = 0.0033;
  cold.blobs.push_back({Point3(0.8, 0.3, 0.5), 0.15, 0, 20});
  scene::FlowProblem warm = cold;
  warm.temperature = 150;
  // Solid cells hold no warmth, which advection leaves out: the flows differ by rounding and by the tolerance alone.
  const auto one = start(cold, {{"tolerance", "1e-12"}}), other = start(warm, {{"tolerance", "1e-12"}});
  testing::run(*one, 10, 0.0625);
  testing::run(*other, 10, 0.0625);
  CHECK(one->totals().greatest_speed > 0.1);
  CHECK(std::abs(one->totals().greatest_speed - other->totals().greatest_speed) < 1e-9);
}

// Rounding in float adds a constant to the residual, which has no solution in a closed part.
TEST_CASE("stable fluids: conjugate gradients in float reach their tolerance in closed boxes", "[stable_fluids]") {
  for (const char* pressure : {"incomplete_cholesky", "transforms_as_guess"}) {
    scene::FlowProblem problem = around_a_ball(3);
    problem.obstacles = {{"ball", scene::Sphere{Point3(0.5, 0.5, 0.5), 0.3}, {}}};
    problem.expansion = 0.0033;
    problem.temperature = 150;
    problem.blobs.push_back({Point3(0.2, 0.4, 0.6), 0.5, 0, 150});
    problem.pushes = {everywhere(Vec3(0, 20, 0))};
    problem.pushes[0].region = Box{Point3(0, 0, 0), Point3(0.5, 1, 1)};
    for (const char* n : {"16", "24"}) {
      const auto flow = start(problem, {{"precision", "float"}, {"pressure", pressure}, {"n", n}});
      CHECK_NOTHROW(testing::run(*flow, 6, 0.0625));
    }
  }
}

}  // namespace rest_test
