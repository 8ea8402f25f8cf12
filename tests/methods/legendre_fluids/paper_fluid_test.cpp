// The paper's own equations: what they do, and what the repaired variant makes of them. Figures are those of the corrected mathematics,
// sections 5 and 6.
#include "methods/legendre_fluids/paper_fluid.h"

#include <Eigen/SVD>
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/legendre_fluids/legendre_fluids.h"
#include "tests/methods/legendre_fluids/swirl.h"

namespace paper_fluid_test {

using namespace airlight;
using namespace airlight::legendre_fluids;
using namespace airlight::legendre_fluids::testing;

namespace {

double squares(const Fluid& fluid) { return fluid.density.squaredNorm(); }

// A Gaussian carried by a velocity that stays, over a time in 200 steps; equations 13 and 14.
std::unique_ptr<PaperFluid> carried(int n, Truncation truncation, double time, const VelocityFunction& u) {
  Material material;
  material.moves = false;
  auto fluid = std::make_unique<PaperFluid>(2, n, Vec3::Ones(), material, truncation, false);
  fluid->begin(u);
  fluid->density = fluid->space().scalar_from_function(
      [](const Vec3& x) { return std::exp(-(x - Vec3(0.35, 0, 0)).squaredNorm() / (2 * 0.25 * 0.25)); });
  for (int step = 0; step < (time > 0 ? 200 : 0); ++step) fluid->advance(time / 200);
  return fluid;
}

Vec3 confined_swirl(const Vec3& x) { return {-x[1] * (1 - x[0] * x[0]), x[0] * (1 - x[1] * x[1]), 0}; }
Vec3 rotation(const Vec3& x) { return {-x[1], x[0], 0}; }

// The swirl of the other tests, as a function.
VelocityFunction smooth(const ConfinedSpace& space, const Array& u) {
  return [&space, u](const Vec3& x) {
    Vec3 v = Vec3::Zero();
    for (int a = 0; a < space.dimensions(); ++a) v[a] = value_at(space, space.component(u, a), a, x);
    return v;
  };
}

}  // namespace

TEST_CASE("legendre fluids, paper: A is the advection of a product cut to n", "[legendre_fluids]") {
  // For a confined velocity without divergence, with T of L2, it is the Galerkin advection of a scalar.
  const ConfinedSpace space(2, 5), larger(2, 6);
  const Array u = swirl(space);
  Components parts;
  for (int a = 0; a < 2; ++a)
    parts[a] = larger.scalar_from_function([&](const Vec3& x) { return value_at(space, space.component(u, a), a, x); });
  PaperAdvection advection(2, 6, Truncation::l2);
  advection.set_velocity(parts);
  const Array r = Array::LinSpaced(36, -1, 2).array().sin();
  Components w;
  for (int a = 0; a < 2; ++a) w[a] = larger.scalar_at_points(parts[a]);
  CHECK(error(-advection(r), larger.scalar_advected(w, r)) < 1e-12);
  // Many small steps of Runge-Kutta are the exponential.
  Array fine = r;
  for (int step = 0; step < 500; ++step)
    fine = runge_kutta_4(fine, 1e-3, [&](const Array& c) { return Array(-advection(c)); });
  CHECK(error(advection.advected(r, 0.5), fine) < 1e-11);
}

TEST_CASE("legendre fluids, paper: what its Laplacian lacks", "[legendre_fluids]") {
  for (const int n : {4, 6, 8, 12}) {
    const PaperLaplacian laplacian(2, n, Vec3::Ones());
    CHECK(laplacian.rank() == n * n - 2 * n);
  }
  const PaperLaplacian laplacian(2, 8, Vec3(1, 0.5, 1));
  const Array c = Array::LinSpaced(64, 0, 9).array().cos(), x = laplacian.diffused(c, 1e-3);
  CHECK(error(x - 1e-3 * laplacian(x), c) < 1e-11);
}

// A problem that is constant along y has one dimension.
TEST_CASE("legendre fluids, paper: implicit diffusion without walls amplifies", "[legendre_fluids]") {
  struct Row {
    int n;
    double amount, norm, accuracy;
  };
  for (const Row& row : {Row{4, 1e-2, 1.1, 0.05}, {4, 1, 23, 0.05}, {8, 1e-2, 6, 0.1}, {8, 1, 3e5, 0.2}}) {
    const PaperLaplacian laplacian(2, row.n, Vec3::Ones());
    Eigen::MatrixXd inverse(row.n, row.n);
    for (int i = 0; i < row.n; ++i) {
      const Array x = laplacian.diffused(Array::Unit(row.n * row.n, i * row.n), row.amount);
      for (int k = 0; k < row.n; ++k) inverse(k, i) = x[k * row.n];
    }
    CAPTURE(row.n, row.amount);
    CHECK(Eigen::JacobiSVD<Eigen::MatrixXd>(inverse).singularValues()[0] == Approx(row.norm).epsilon(row.accuracy));
  }
}

TEST_CASE("legendre fluids, paper: figure 7 in a confined velocity", "[legendre_fluids]") {
  const auto start = carried(12, Truncation::l2, 0, confined_swirl);
  const auto chebyshev = carried(12, Truncation::chebyshev, 2 * pi, confined_swirl);
  const auto l2 = carried(12, Truncation::l2, 2 * pi, confined_swirl);
  CHECK(squares(*l2) / squares(*start) == Approx(1).epsilon(1e-12));
  CHECK(l2->density[0] == Approx(start->density[0]).epsilon(1e-12));
  CHECK(squares(*chebyshev) / squares(*start) == Approx(0.99976).margin(2e-5));
  CHECK(chebyshev->density[0] / start->density[0] == Approx(0.99942).margin(2e-5));
}

TEST_CASE("legendre fluids, paper: figure 7 in a rotation through the sides gains energy", "[legendre_fluids]") {
  const auto start = carried(12, Truncation::l2, 0, rotation);
  CHECK(squares(*carried(12, Truncation::chebyshev, 2 * pi, rotation)) / squares(*start) == Approx(38).epsilon(0.03));
  CHECK(squares(*carried(12, Truncation::l2, 2 * pi, rotation)) / squares(*start) == Approx(51).epsilon(0.03));
}

TEST_CASE("legendre fluids, paper: velocities that move themselves blow up, repaired ones do not",
          "[legendre_fluids]") {
  for (const Truncation truncation : {Truncation::chebyshev, Truncation::l2})
    for (const int n : {6, 8, 12}) {
      const ConfinedSpace space(2, n - 1);
      const Array u = swirl(space);
      PaperFluid paper(2, n, Vec3::Ones(), {}, truncation, false), repaired(2, n, Vec3::Ones(), {}, truncation, true);
      paper.begin(smooth(space, u));
      repaired.begin(smooth(space, u));
      const double start = repaired.energy();
      CAPTURE(n, int(truncation));
      CHECK(start == Approx(0.5 * space.inner(u, u)).epsilon(1e-12));
      int steps = 0;
      const auto run = [&] {
        for (; steps < 1000; ++steps) {
          paper.advance(0.01);
          paper.finish(0.01);
        }
      };
      CHECK_THROWS_AS(run(), scene::Unstable);
      CHECK(steps < 300);
      double before = start;
      bool falls = true;
      for (int step = 0; step < 300; ++step) {
        repaired.advance(0.01);
        repaired.finish(0.01);
        falls &= repaired.energy() <= before * (1 + 1e-12);
        before = repaired.energy();
      }
      // With T of L2 advection is an isometry and the projection orthogonal; that of Chebyshev promises neither.
      if (truncation == Truncation::l2) CHECK(falls);
      CHECK(before > 0.7 * start);
      CHECK(before < 1.1 * start);
      CHECK(std::abs(repaired.at(0, Vec3(1, 0.3, 0))) < 1e-12);
    }
}

TEST_CASE("legendre fluids, paper: the solver says after how many steps, and refuses what the variants lack",
          "[legendre_fluids]") {
  const LegendreFluids solver;
  const auto settings = [&](std::map<std::string, std::string> given) {
    given.try_emplace("variant", "paper");
    return scene::Settings(solver.settings(), given);
  };
  scene::FlowProblem problem;
  problem.dimensions = 2;
  problem.box = {Point3(-1, -1, 0), Point3(1, 1, 0)};
  problem.velocity = scene::Swirl{1};
  const auto flow = solver.start(std::make_shared<const scene::FlowProblem>(problem), settings({{"n", "8"}}), {});
  const auto run = [&] {
    for (int step = 0; step < 3000; ++step) flow->step(0.01);
  };
  CHECK_THROWS_WITH(run(), Catch::Matches("step [0-9]+, t = .* times in a step: .*walls"));
  problem.sides[0][0].kind = scene::Side::Kind::open;
  CHECK_THAT(solver.supports(problem, settings({})).back(), Catch::Contains("paper with open sides"));
  problem.sides[0][0].kind = scene::Side::Kind::free_slip;
  CHECK_THAT(solver.supports(problem, settings({{"n", "40"}})).at(0), Catch::Contains("1600"));
  CHECK(solver.supports(problem, settings({{"n", "40"}, {"variant", "paper_repaired"}})).empty());
}

}  // namespace paper_fluid_test
