// Whole flows of Legendre fluids: what they keep, what they refuse, restart, wind, agreement with closed forms and Stable Fluids.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/exact_flows/exact_flows.h"
#include "reference/stable_fluids/stable_fluids.h"
#include "tests/methods/legendre_fluids/flows.h"

namespace flow_test {

using namespace airlight;
using namespace airlight::legendre_fluids::testing;
using Catch::Contains;
using Kind = scene::Side::Kind;

namespace {

FlowProblem warm_blob(int dimensions) {
  FlowProblem problem = box(dimensions);
  problem.gravity = Vec3(0, -9.81, 0);
  problem.expansion = 1.0 / 300;
  problem.viscosity = 1e-3;
  problem.blobs.push_back({Point3(0.5, 0.3, dimensions == 2 ? 0 : 0.5), 0.25, 1, 30});
  return problem;
}

// Relative difference of the velocities, or densities, on a lattice of 21 points along an axis.
double difference(const scene::Flow& a, const scene::Flow& b, const FlowProblem& p, bool of_density = false) {
  double squares = 0, all = 0;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j) {
      Point3 x = p.box.lo + Vec3(i, j, 10).cwiseProduct(p.box.size()) / 20;
      const Vec3 u = of_density ? Vec3(a.density(x), 0, 0) : a.velocity(x);
      const Vec3 v = of_density ? Vec3(b.density(x), 0, 0) : b.velocity(x);
      squares += (u - v).squaredNorm();
      all += v.squaredNorm();
    }
  return std::sqrt(squares / all);
}

}  // namespace

TEST_CASE("legendre fluids: what acts on a flow is of second order in the step", "[legendre_fluids]") {
  FlowProblem problem = warm_blob(2);
  problem.weight = 0.05, problem.decay = 2;
  scene::Source source;
  source.region = scene::Sphere{Point3(0.5, 0.4, 0), 0.3};
  source.density_rate = 3, source.temperature_rate = 100;
  problem.sources.push_back(source);
  scene::Push push;
  push.region = scene::Sphere{Point3(0.4, 0.6, 0), 0.3};
  push.acceleration = Vec3(2, 1, 0), push.frequency = 1;
  problem.pushes.push_back(push);
  const auto after = [&](int steps) {
    auto flow = start(problem, {{"n", "10"}});
    run(*flow, steps, 0.4 / steps);
    return flow;
  };
  const auto fine = after(256), coarse = after(4), half = after(8);
  for (const bool of_density : {false, true}) {
    const double ratio =
        difference(*coarse, *fine, problem, of_density) / difference(*half, *fine, problem, of_density);
    CAPTURE(of_density, ratio);
    CHECK(ratio > 3.7);
    CHECK(ratio < 4.3);
  }
  // All the same everywhere, alone: the density is rate / decay (1 - exp(-decay t)).
  FlowProblem still = box(2);
  still.decay = 2;
  source.region = Box{Point3(-1, -1, -1), Point3(2, 2, 1)}, source.temperature_rate = 0;
  still.sources.push_back(source);
  const auto error = [&](int steps) {
    auto flow = start(still, {{"n", "3"}});
    run(*flow, steps, 0.4 / steps);
    return std::abs(flow->density(Point3(0.5, 0.5, 0)) / (1.5 * (1 - std::exp(-0.8))) - 1);
  };
  CHECK(error(8) == Approx(0.1 * 0.1 / 24).epsilon(0.01));  // (dt decay)^2 / 24 is what halves leave
  CHECK(error(4) / error(8) == Approx(4).epsilon(0.02));
}

TEST_CASE("legendre fluids: Taylor-Green vortices agree with the closed form in boxes of any size",
          "[legendre_fluids]") {
  for (const double side : {1.0, 2.0}) {
    FlowProblem problem = box(2, Vec3(side, 2 * side, 1));
    problem.box.lo += Vec3(-3, 1, 0), problem.box.hi += Vec3(-3, 1, 0);
    problem.velocity = scene::TaylorGreen{side, 1};
    problem.viscosity = 2.5e-3 * side * side;
    const auto exact = start<exact_flows::ExactFlows>(problem, {}), flow = start(problem, {{"n", "16"}});
    CHECK(difference(*flow, *exact, problem) < 1e-9);
    for (int step = 0; step < 50; ++step) flow->step(0.01), exact->step(0.01);
    CHECK(difference(*flow, *exact, problem) < 1e-8);
    CHECK(flow->totals().energy == Approx(exact->totals().energy).epsilon(1e-8));
    CHECK(flow->totals().enstrophy == Approx(exact->totals().enstrophy).epsilon(1e-6));
    CHECK(flow->totals().divergence < 1e-11);
    CHECK(flow->time() == Approx(0.5));
  }
}

TEST_CASE("legendre fluids: energy and mass of a swirl that carries a blob stay", "[legendre_fluids]") {
  FlowProblem problem = box(2);
  problem.velocity = scene::Swirl{1};
  problem.blobs.push_back({Point3(0.6, 0.3, 0), 0.2, 1, 0});
  const auto flow = start(problem, {{"n", "12"}});
  const auto before = flow->totals();
  run(*flow, 200, 0.01);
  const auto after = flow->totals();
  CHECK(after.energy == Approx(before.energy).epsilon(1e-8));
  CHECK(after.mass == Approx(before.mass).epsilon(1e-13));
  CHECK((after.center_of_mass - before.center_of_mass).norm() > 0.05);
  CHECK(after.divergence < 1e-12);
}

TEST_CASE("legendre fluids: a warm blob rises as in Stable Fluids", "[legendre_fluids]") {
  const FlowProblem problem = warm_blob(2);
  const auto flow = start(problem, {{"n", "20"}});
  const auto grid = start<stable_fluids::StableFluids>(problem, {{"n", "128"}, {"precision", "double"}});
  run(*flow, 100, 0.005);
  run(*grid, 100, 0.005);
  CHECK(flow->totals().center_of_mass[1] == Approx(grid->totals().center_of_mass[1]).epsilon(0.01));
  CHECK(difference(*flow, *grid, problem) < 0.1);
  CHECK(difference(*flow, *grid, problem, true) < 0.1);
}

TEST_CASE("legendre fluids: in three dimensions a blob rises upright", "[legendre_fluids]") {
  const auto flow = start(warm_blob(3), {{"n", "8"}});
  const auto before = flow->totals();
  run(*flow, 20, 0.02);
  const auto after = flow->totals();
  CHECK(after.center_of_mass[1] > before.center_of_mass[1] + 0.01);
  CHECK(std::abs(after.center_of_mass[0] - 0.5) < 1e-12);
  CHECK(after.mass == Approx(before.mass).epsilon(1e-12));
  for (const double x : {0.1, 0.35, 0.8}) {
    CHECK(flow->density(Point3(x, 0.6, 0.4)) == Approx(flow->density(Point3(0.4, 0.6, x))).margin(1e-12));
    CHECK(std::abs(flow->velocity(Point3(0, x, 0.3))[0]) < 1e-12);
  }
}

TEST_CASE("legendre fluids: restart gives the same bits", "[legendre_fluids]") {
  const Given settings{{"n", "8"}, {"filter_carried", "1"}};
  const auto whole = start(warm_blob(2), settings), again = start(warm_blob(2), settings);
  run(*whole, 5, 0.02);
  again->restore(whole->state());
  run(*whole, 5, 0.02);
  run(*again, 5, 0.02);
  CHECK(whole->state() == again->state());
  std::string damaged = whole->state();
  damaged[damaged.size() / 2] ^= 1;
  CHECK_THROWS_WITH(again->restore(damaged), Contains("damaged"));
  CHECK_THROWS_WITH(start(warm_blob(2), {{"n", "9"}})->restore(whole->state()), Contains("expected"));
}

TEST_CASE("legendre fluids: what a rotation turns comes back", "[legendre_fluids]") {
  FlowProblem problem = box(2, Vec3(2, 2, 1));
  problem.velocity = scene::RigidRotation{Point3(1, 1, 0), Vec3::UnitZ()};
  problem.velocity_stays = true;
  // Standard deviation .25, as in section 6 of the corrected mathematics.
  problem.blobs.push_back({Point3(1.35, 1, 0), 0.25 * std::sqrt(2.0), 1, 0});
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const auto flow = start(problem, {{"n", i ? "16" : "12"}}), first = start(problem, {{"n", i ? "16" : "12"}});
    run(*flow, 200, pi / 100);
    error[i] = difference(*flow, *start<exact_flows::ExactFlows>(problem, {}), problem, true);
    CHECK(flow->totals().mass == Approx(first->totals().mass).epsilon(0.02));
    CHECK(flow->totals().energy == Approx(first->totals().energy));
  }
  CAPTURE(error[0], error[1]);
  CHECK(error[0] < 0.04);
  CHECK(error[1] < 0.02);
}

TEST_CASE("legendre fluids: wind blows a box clean, and brings what comes in", "[legendre_fluids]") {
  FlowProblem problem = box(2, Vec3(2, 1, 1));
  problem.velocity = scene::Wind{Vec3(1, 0, 0)};
  for (scene::Side& side : problem.sides[0]) side.kind = Kind::open;
  problem.density = 1;
  auto flow = start(problem, {{"n", "8"}});
  run(*flow, 60, 0.1);
  CHECK(std::abs(flow->totals().mass) < 1e-4);
  CHECK((flow->velocity(Point3(0.3, 0.2, 0)) - Vec3(1, 0, 0)).norm() < 1e-12);
  problem.sides[0][0].density = 0.25;
  flow = start(problem, {{"n", "8"}});
  run(*flow, 60, 0.1);
  CHECK(flow->totals().mass == Approx(0.5).epsilon(1e-3));
  CHECK(flow->density(Point3(1.9, 0.5, 0)) == Approx(0.25).epsilon(1e-3));
}

TEST_CASE("legendre fluids: sources, decay, diffusion and filters", "[legendre_fluids]") {
  FlowProblem problem = box(2);
  problem.decay = 0.5;
  problem.diffusivity = 0.01;
  scene::Source source;
  source.region = Box{Point3(0.25, 0.25, -1), Point3(0.75, 0.5, 1)};
  source.time = {0, 1};
  source.density_rate = 2;
  problem.sources.push_back(source);
  const auto flow = start(problem, {{"n", "10"}, {"filter_carried", "5"}});
  run(*flow, 200, 0.01);
  // m' = -decay m + 2 * area for a second, then decay alone; sources are added at the beginning of a step.
  const double rate = 2 * 0.125, filled = rate / 0.5 * (1 - std::exp(-0.5));
  CHECK(flow->totals().mass == Approx(filled * std::exp(-0.5)).epsilon(0.03));
  problem.sources[0].region = scene::Sphere{Point3(0.51, 0.5, 0), 1e-9};
  CHECK_THROWS_WITH(start(problem, {}), Contains("source 0"));
}

TEST_CASE("legendre fluids: what is not polynomial in a box is refused by name", "[legendre_fluids]") {
  CHECK(objections(box(3)).empty());
  FlowProblem problem = box(3);
  problem.sides[1][0].kind = Kind::no_slip;
  CHECK_THAT(objections(problem).at(0), Contains("axis y are no_slip"));
  problem = box(3);
  problem.sides[0][0].kind = problem.sides[0][1].kind = Kind::periodic;
  CHECK_THAT(objections(problem).at(0), Contains("axis x are periodic"));
  problem = box(3);
  problem.sides[2][1].kind = Kind::open;
  CHECK_THAT(objections(problem).at(0), Contains("open"));
  problem = box(3);
  problem.confinement = 1;
  CHECK_THAT(objections(problem).at(0), Contains("confinement"));
  problem = box(3);
  problem.sources.push_back({});
  problem.sources[0].density = 1;
  CHECK_THAT(objections(problem).at(0), Contains("sources"));
}

TEST_CASE("legendre fluids: one coefficient is a fluid at rest, long steps are divided", "[legendre_fluids]") {
  FlowProblem problem = warm_blob(2);
  const auto flow = start(problem, {{"n", "1"}});
  const double mass = flow->totals().mass;
  run(*flow, 3, 0.1);
  CHECK(flow->totals().mass == mass);
  CHECK(flow->totals().energy == 0);
  problem.velocity = scene::Swirl{10};
  const auto fast = start(problem, {{"n", "8"}});
  fast->step(1);
  CHECK(fast->counters().at("Runge-Kutta steps") > 30);
  CHECK(fast->totals().greatest_speed < 12);
}

}  // namespace flow_test
