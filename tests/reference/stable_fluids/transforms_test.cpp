// Transforms and projections against the difference operators that they invert, at every pair of sides.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "reference/stable_fluids/diffusion.h"
#include "reference/stable_fluids/pressure.h"
#include "scene/base/error.h"
#include "scene/geometry/shapes.h"
#include "tests/reference/stable_fluids/problems.h"
#include "tests/texts.h"

namespace transforms_test {

using namespace airlight;
using namespace airlight::stable_fluids;
using testing::box_problem;
using testing::Kind;

namespace {

const std::vector<std::array<Kind, 2>>& pairs_of_sides() {
  static const std::vector<std::array<Kind, 2>> pairs = [] {
    std::vector<std::array<Kind, 2>> all = {{Kind::periodic, Kind::periodic}};
    for (const Kind low : {Kind::free_slip, Kind::no_slip, Kind::open})
      for (const Kind high : {Kind::free_slip, Kind::no_slip, Kind::open}) all.push_back({low, high});
    return all;
  }();
  return pairs;
}

Lattice lattice(int dimensions, const Vec3& size, int longest, const std::array<std::size_t, 3>& which) {
  scene::FlowProblem problem = box_problem(dimensions, size);
  for (int a = 0; a < dimensions; ++a)
    for (int side = 0; side < 2; ++side) problem.sides[a][side].kind = pairs_of_sides()[which[a]][side];
  return make_lattice(problem, longest);
}

template <class Body>
void each_pair(const Body& body) {
  const std::size_t count = pairs_of_sides().size();
  for (std::size_t x = 0; x < count; ++x)
    for (std::size_t y = 0; y < count; ++y) body(lattice(2, Vec3(0.5, 0.7, 0), 7, {x, y, 0}));
  // In space each pair with two others.
  for (std::size_t x = 0; x < count; ++x)
    body(lattice(3, Vec3(0.5, 0.4, 0.3), 5, {x, (3 * x + 1) % count, (7 * x + 2) % count}));
}

template <class Real>
void randomize(Field<Real>& f, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < f.n[2]; ++k)
    for (int j = 0; j < f.n[1]; ++j)
      for (int i = 0; i < f.n[0]; ++i) f.at(i, j, k) = Real(any(random));
}

// Greatest |x - amount Laplacian x - y| over samples that are unknown, by differences and ghosts.
double residual(Field<double> x, const Field<double>& y, Quantity quantity, const Lattice& l, double amount) {
  fill_ghosts(x, quantity, l);
  double most = 0;
  for (int k = 0; k < x.n[2]; ++k)
    for (int j = 0; j < x.n[1]; ++j)
      for (int i = 0; i < x.n[0]; ++i) {
        const int at = x.axis == 0 ? i : x.axis == 1 ? j : k;
        if (x.axis >= 0 && on_side(x, x.axis, at, l) && l.sides[x.axis][at == 0 ? 0 : 1].kind != Kind::open) continue;
        double sum = 0;
        for (int a = 0; a < l.dimensions; ++a) {
          const double* here = x.row(j, k) + i;
          sum += here[x.stride[a]] + here[-x.stride[a]] - 2 * here[0];
        }
        most = std::max(most, std::abs(x.at(i, j, k) - amount / (l.h * l.h) * sum - y.at(i, j, k)));
      }
  return most;
}

template <class Real>
Velocity<Real> random_velocity(const Lattice& l, std::mt19937& random) {
  Velocity<Real> u;
  for (int a = 0; a < l.dimensions; ++a) {
    u[a] = Field<Real>(l, a);
    randomize(u[a], random);
    fill_ghosts(u[a], Quantity::velocity, l);
  }
  return u;
}

template <class Real>
void settle(Velocity<Real>& u, const Lattice& l, const Obstacles& obstacles) {
  for (int a = 0; a < l.dimensions; ++a) {
    stop_at_obstacles(obstacles, u[a]);
    fill_ghosts(u[a], Quantity::velocity, l);
  }
}

template <class Real>
double divergence_left(const Lattice& l, const Obstacles& obstacles, PressureSolver which, double tolerance) {
  std::mt19937 random(3);
  auto u = random_velocity<Real>(l, random);
  settle(u, l, obstacles);
  Projection<Real>(l, obstacles, which, tolerance, 500)(u);
  settle(u, l, obstacles);
  return greatest_divergence(u, l, obstacles);
}

}  // namespace

TEST_CASE("stable fluids: transforms invert diffusion at every pair of sides", "[stable_fluids]") {
  std::mt19937 random(1);
  each_pair([&](Lattice l) {
    // Walls that move and inflows, so that what they add is there too.
    for (int a = 0; a < l.dimensions; ++a)
      for (scene::Side& side : l.sides[a])
        if (side.kind == Kind::no_slip) {
          side.velocity = Vec3(0.3, -0.2, l.dimensions == 3 ? 0.4 : 0);
          side.density = 0.7;
        }
    for (int axis = at_centers; axis < l.dimensions; ++axis)
      for (const double amount : {1e-4, 0.02, 30.0}) {
        Field<double> y(l, axis);
        randomize(y, random);
        const Quantity quantity = axis < 0 ? Quantity::density : Quantity::velocity;
        fill_ghosts(y, quantity, l);
        Field<double> x = y;
        Diffusion<double>(l, {}, axis, 1e-12, 100)(x, quantity, amount);
        CHECK(residual(x, y, quantity, l, amount) < 1e-13 * (1 + amount / (l.h * l.h)));
      }
  });
}

TEST_CASE("stable fluids: nothing diverges after a projection, at every pair of sides", "[stable_fluids]") {
  each_pair([&](const Lattice& l) {
    CHECK(divergence_left<double>(l, {}, PressureSolver::transforms, 0) < 1e-12);
    CHECK(divergence_left<float>(l, {}, PressureSolver::transforms, 0) < 1e-5);
    for (const PressureSolver which : {PressureSolver::incomplete_cholesky, PressureSolver::transforms_as_guess}) {
      CHECK(divergence_left<double>(l, {}, which, 1e-10) < 4e-9);  // ten times the tolerance, of divergences up to 4
      CHECK(divergence_left<float>(l, {}, which, 1e-4) < 4e-3);
    }
  });
}

TEST_CASE("stable fluids: a projection keeps walls, and what is free of divergence", "[stable_fluids]") {
  std::mt19937 random(5);
  each_pair([&](const Lattice& l) {
    auto u = random_velocity<double>(l, random);
    const Obstacles none;
    Projection<double> project(l, none, PressureSolver::transforms, 0, 0);
    project(u);
    settle(u, l, none);
    auto again = u;
    project(again);
    for (int a = 0; a < l.dimensions; ++a)
      for (int k = 0; k < u[a].n[2]; ++k)
        for (int j = 0; j < u[a].n[1]; ++j)
          for (int i = 0; i < u[a].n[0]; ++i) {
            CHECK(std::abs(again[a].at(i, j, k) - u[a].at(i, j, k)) < 1e-13);
            const int at = a == 0 ? i : a == 1 ? j : k;
            if (on_side(u[a], a, at, l) && l.sides[a][at == 0 ? 0 : 1].kind != Kind::open) CHECK(u[a].at(i, j, k) == 0);
          }
  });
}

TEST_CASE("stable fluids: nothing diverges among obstacles, in closed parts either", "[stable_fluids]") {
  for (const Kind sides : {Kind::free_slip, Kind::periodic, Kind::open}) {
    scene::FlowProblem problem = box_problem(3, Vec3(1, 1, 1), sides);
    problem.obstacles = {{"ball", scene::Sphere{Point3(0.4, 0.5, 0.6), 0.22}, {}},
                         {"second", scene::Sphere{Point3(0.8, 0.2, 0.2), 0.1}, {}}};
    const Lattice l = make_lattice(problem, 12);
    const Obstacles obstacles = make_obstacles(problem, l);
    CHECK(obstacles.count > 50);
    for (const PressureSolver which : {PressureSolver::incomplete_cholesky, PressureSolver::transforms_as_guess})
      CHECK(divergence_left<double>(l, obstacles, which, 1e-10) < 6e-9);
  }
  // A wall that splits the box in two, each part with a constant pressure of its own.
  scene::FlowProblem problem = box_problem(3, Vec3(1, 1, 1));
  problem.obstacles = {{"wall", scene::make_box({Point3(0.45, -1, -1), Point3(0.6, 2, 2)}), {}}};
  const Lattice l = make_lattice(problem, 10);
  const Obstacles obstacles = make_obstacles(problem, l);
  CHECK(obstacles.count == 200);
  for (const PressureSolver which : {PressureSolver::incomplete_cholesky, PressureSolver::transforms_as_guess})
    CHECK(divergence_left<double>(l, obstacles, which, 1e-10) < 6e-9);
}

TEST_CASE("stable fluids: a flow that cannot be balanced is refused with its flux", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0));
  problem.sides[0][0] = {Kind::no_slip, Vec3(2, 0, 0)};
  const auto message = [&] { return test::message_of([&] { testing::start(problem, {}); }); };
  CHECK(message() == "2 m^2/s flow into a part of 256 cells that has no open side, expected as much in as out");
  problem.sides[0][1] = {Kind::no_slip, Vec3(2, 0, 0)};
  CHECK(message().empty());
  problem.sides[0][1] = {Kind::open};
  CHECK(message().empty());
  // A ball across the box: what is left of it has an inflow and no side that is open.
  problem.obstacles = {{"ball", scene::Sphere{Point3(0.5, 0.5, 0), 0.6}, {}}};
  CHECK(message().find("has no open side") != std::string::npos);
}

}  // namespace transforms_test
