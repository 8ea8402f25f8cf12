// Forces, sources and obstacles against laws that need no reference: what a parcel's acceleration, a source's rate and a ball's cells are.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/stable_fluids/obstacles.h"
#include "tests/reference/stable_fluids/problems.h"

namespace laws_test {

using namespace airlight;
using namespace airlight::stable_fluids;
using testing::box_problem;
using testing::Kind;
using testing::start;

namespace {

scene::Source within(double low, double high) {
  scene::Source source;
  source.region = Box{Point3(low, -1, -1), Point3(high, 2, 2)};
  return source;
}

// A shear u_x = sin(2 pi y) in a periodic box of n x n cells, as a file would give it.
std::shared_ptr<const scene::VelocityGrid> shear(int n) {
  scene::VelocityGrid grid;
  for (int a = 0; a < 3; ++a) {
    grid[a].size = {n + 1, n, 1};
    grid[a].voxel_size = 1.0 / n;
    grid[a].translation = Vec3(0, 0.5 / n, 0);
    for (int i = 0; i < n * (n + 1); ++i)
      grid[a].values.push_back(a == 0 ? float(std::sin(2 * pi * (i / (n + 1) + 0.5) / n)) : 0.0f);
  }
  return std::make_shared<const scene::VelocityGrid>(grid);
}

}  // namespace

// Columns from floor to ceiling of a box that is periodic along y: no pressure holds them, and advection along y moves nothing.
TEST_CASE("stable fluids: a warm column accelerates as its expansion says, a heavy one as its weight does",
          "[stable_fluids]") {
  const int dimensions = GENERATE(2, 3);
  scene::FlowProblem problem = box_problem(dimensions, Vec3(1, 1, 1));
  problem.sides[1][0].kind = problem.sides[1][1].kind = Kind::periodic;
  problem.gravity = Vec3(0, -9.81, 0);
  problem.expansion = 1.0 / 300;
  problem.weight = 0.2;
  problem.sources = {within(0.5, 2), within(-1, 0.25)};
  problem.sources[0].temperature = 30;
  problem.sources[1].density = 0.4;
  const auto flow = start(problem, {});
  testing::run(*flow, 16, 0.0625);
  const auto rise = [&](double x) { return flow->velocity(Point3(x, 0.3, dimensions == 2 ? 0 : 0.4))[1]; };
  CHECK(rise(0.75) == Approx(9.81 * 30 / 300).epsilon(1e-12));  // a t, t = 1 s
  CHECK(rise(0.125) == Approx(-9.81 * 0.2 * 0.4).epsilon(1e-12));
  CHECK(std::abs(rise(0.375)) < 1e-12);
}

TEST_CASE("stable fluids: a source brings its rate times its volume times its time", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(3, Vec3(1, 1, 1));
  scene::Source source;
  source.region = Box{Point3::Constant(0.25), Point3::Constant(0.5)};
  source.time = {0.013, 0.087};  // neither begins nor ends with a step
  source.density_rate = 3;
  source.temperature_rate = 40;
  problem.sources.push_back(source);
  const auto flow = start(problem, {});
  testing::run(*flow, 10, 0.02);
  CHECK(flow->totals().mass == Approx(3 * 0.074 / 64).epsilon(1e-12));
  CHECK(flow->temperature(Point3(0.4, 0.4, 0.4)) == Approx(40 * 0.074).epsilon(1e-12));
}

// Everything decays alike, wherever it is: d' = -decay d has one solution.
TEST_CASE("stable fluids: smoke decays as the exponential of its rate", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
  problem.density = 0.5;
  problem.decay = 0.7;
  const auto flow = start(problem, {});
  testing::run(*flow, 10, 0.2);
  CHECK(flow->density(Point3(0.3, 0.4, 0)) == Approx(0.5 * std::exp(-1.4)).epsilon(1e-12));
}

TEST_CASE("stable fluids: a force that swings brings the integral of its cosine", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
  problem.pushes.push_back({Box{Point3::Constant(-1), Point3::Constant(2)}, {0.03, 1}, Vec3(2, 0, 0), 1.25});
  const auto flow = start(problem, {});
  testing::run(*flow, 7, 0.05);
  const double w = 2 * pi * 1.25;
  CHECK(flow->velocity(Point3(0.3, 0.4, 0))[0] ==
        Approx(2 * (std::sin(w * 0.35) - std::sin(w * 0.03)) / w).epsilon(1e-12));
}

// f = epsilon h N x omega, N = grad |omega| / |grad |omega||: of a shear along x, which nothing else changes, f_x = epsilon h N_y omega_z.
TEST_CASE("stable fluids: confinement accelerates a shear by epsilon h times its vorticity", "[stable_fluids]") {
  const int n = 16;
  const double epsilon = 0.3, dt = 0.01, h = 1.0 / n;
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::periodic);
  problem.velocity_grid = shear(n);
  problem.confinement = epsilon;
  const auto flow = start(problem, {});
  flow->step(dt);
  const auto omega = [&](double y) {
    return -std::cos(2 * pi * y) * std::sin(2 * pi * h) / h;
  };  // by centred differences
  for (int j = 0; j < n; ++j) {
    const double y = (j + 0.5) * h, slope = std::abs(omega(y + h)) - std::abs(omega(y - h));
    const double force = epsilon * h * (slope > 0 ? 1 : -1) * omega(y);
    CAPTURE(y, force);
    CHECK(std::abs(flow->velocity(Point3(0.25, y, 0))[0] - std::sin(2 * pi * y) - dt * force) <
          2e-7);  // the file is in float
  }
}

// Between a wall that stands and a lid, steady: u = U y, which differences of second order have exactly.
TEST_CASE("stable fluids: viscosity between a wall and a lid ends in Couette's straight line", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(2, Vec3(1, 1, 0), Kind::no_slip);
  problem.sides[0][0].kind = problem.sides[0][1].kind = Kind::periodic;
  problem.sides[1][1].velocity = Vec3(0.8, 0, 0);
  problem.viscosity = 1;
  const auto flow = start(problem, {});
  testing::run(*flow, 60, 0.25);
  for (const double y : {0.03125, 0.34375, 0.96875})
    CHECK(flow->velocity(Point3(0.3, y, 0))[0] == Approx(0.8 * y).epsilon(1e-10));
}

TEST_CASE("stable fluids: the energy of a wind is half its square times the box, its mass the density's",
          "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(3, Vec3(1, 0.5, 0.25), Kind::open);
  problem.velocity = scene::Wind{Vec3(0.7, 0.4, -0.3)};
  problem.density = 0.6;
  const scene::Totals totals = start(problem, {})->totals();
  CHECK(totals.energy == Approx(0.5 * 0.74 * 0.125).epsilon(1e-12));
  CHECK(totals.mass == Approx(0.6 * 0.125).epsilon(1e-12));
  CHECK((totals.center_of_mass - Point3(0.5, 0.25, 0.125)).norm() < 1e-12);
}

// A ball's cells are those whose middle it holds. From a cell one may go `clear` cells along every axis and meet none of them, and no more.
TEST_CASE("stable fluids: what is solid of a ball, and how far it is to it", "[stable_fluids]") {
  scene::FlowProblem problem = box_problem(3, Vec3(1, 1, 1));
  const Point3 center(0.451, 0.553, 0.507);
  problem.obstacles = {{"ball", scene::Sphere{center, 0.2}, {}}};
  const Lattice l = make_lattice(problem, 20);
  const Obstacles obstacles = make_obstacles(problem, l);
  const auto solid = [&](int i, int j, int k) {
    return (Point3(i + 0.5, j + 0.5, k + 0.5) / 20 - center).norm() < 0.2;
  };
  std::vector<std::array<int, 3>> cells;
  int wrong = 0;
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 20; ++i) {
        if (solid(i, j, k)) cells.push_back({i, j, k});
        wrong += bool(obstacles.solid.at(i, j, k)) != solid(i, j, k);
      }
  CHECK(wrong == 0);
  CHECK(obstacles.count == cells.size());
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 20; ++i) {
        int nearest = 20;
        for (const auto& c : cells)
          nearest = std::min(nearest, std::max({std::abs(c[0] - i), std::abs(c[1] - j), std::abs(c[2] - k)}));
        wrong += obstacles.clear[std::size_t(i + 20 * (j + 20 * k))] != std::max(0, nearest - 1);
      }
  CHECK(wrong == 0);
}

}  // namespace laws_test
