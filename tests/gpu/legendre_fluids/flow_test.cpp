// Whole flows on the device: agreement with the CPU, what they keep, what passes between both, extremes, refusals.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/legendre_fluids/confined_fluid.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/device.h"
#include "tests/gpu/legendre_fluids/flows_on_device.h"
#include "tests/methods/legendre_fluids/swirl.h"

namespace flow_test {

using namespace airlight;
using Catch::Contains;
using namespace gpu::test;

namespace {

struct Difference {
  double velocity = 0, density = 0, temperature = 0;  // greatest over a lattice, over the greatest value
};
Difference difference(const scene::Flow& a, const scene::Flow& b, const FlowProblem& p) {
  Difference d;
  Vec3 most = Vec3::Constant(1e-300);
  for (int i = 0; i < 125; ++i) {
    const Point3 x = p.box.lo + Vec3(i % 5, i / 5 % 5, i / 25).cwiseProduct(p.box.size()) / 4;
    const Vec3 values(b.velocity(x).norm(), std::abs(b.density(x)), std::abs(b.temperature(x)));
    most = most.cwiseMax(values);
    d.velocity = std::max(d.velocity, (a.velocity(x) - b.velocity(x)).norm());
    d.density = std::max(d.density, std::abs(a.density(x) - b.density(x)));
    d.temperature = std::max(d.temperature, std::abs(a.temperature(x) - b.temperature(x)));
  }
  return {d.velocity / most[0], d.density / most[1], d.temperature / most[2]};
}

std::vector<std::string> objections(const FlowProblem& problem, const Given& settings) {
  const gpu::legendre_fluids::LegendreFluids solver;
  return solver.supports(problem, scene::Settings(solver.settings(), settings));
}

}  // namespace

DEVICE_TEST_CASE("legendre fluids on the device: flows agree with the CPU after many steps",
                 "[gpu][legendre_fluids][thorough]") {
  struct Case {
    int dimensions;
    const char* n;
    bool stays;
  };
  for (const Case& c :
       {Case{3, "5", false}, Case{3, "8", false}, Case{3, "8", true}, Case{2, "7", false}, Case{2, "16", false}}) {
    FlowProblem problem = everything(c.dimensions);
    problem.velocity_stays = c.stays;
    const Given settings{{"n", c.n}, {"filter_velocity", "0.5"}, {"filter_carried", "1"}};
    const auto cpu = start<legendre_fluids::LegendreFluids>(problem, settings), gpu = on_device(problem, settings);
    const Difference before = difference(*gpu, *cpu, problem);
    run(*cpu, 40, 0.02);
    run(*gpu, 40, 0.02);
    const Difference d = difference(*gpu, *cpu, problem);
    CAPTURE(c.dimensions, c.n, c.stays);
    CHECK(before.velocity < 1e-6);
    CHECK(d.velocity < 2e-5);
    CHECK(d.density < 2e-5);
    CHECK(d.temperature < 2e-5);
    for (const char* counter : {"steps", "Runge-Kutta steps"})
      CHECK(gpu->counters().at(counter) == cpu->counters().at(counter));
    CHECK(gpu->time() == cpu->time());
    const auto dye = std::get<scene::LegendrePointer>(gpu->medium(1)),
               same = std::get<scene::LegendrePointer>(cpu->medium(1));
    CHECK((dye->coefficients() - same->coefficients()).cwiseAbs().maxCoeff() < 2e-5 * same->coefficients()[0]);
    CHECK(gpu->totals().mass == Approx(cpu->totals().mass).epsilon(1e-5));
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: an albedo that moves is the CPU's",
                 "[gpu][legendre_fluids][thorough]") {
  for (const char* variant : {"galerkin", "paper", "paper_repaired"})
    for (const int dimensions : {2, 3}) {
      FlowProblem problem = everything(dimensions);
      problem.diffusivity = 0;
      for (scene::Source& source : problem.sources) source.density_rate = 0;
      const Given settings{{"n", "6"}, {"mixing", "albedo"}, {"variant", variant}};
      const auto cpu = start<legendre_fluids::LegendreFluids>(problem, settings), gpu = on_device(problem, settings);
      // Before a step, after some, and after a restart.
      const auto alike = [&] {
        for (const int which : {0, 1}) {
          const auto mine = std::get<scene::LegendrePointer>(gpu->medium(which)),
                     theirs = std::get<scene::LegendrePointer>(cpu->medium(which));
          CAPTURE(variant, dimensions, which);
          CHECK((mine->coefficients() - theirs->coefficients()).cwiseAbs().maxCoeff() <
                2e-5 * theirs->coefficients().cwiseAbs().maxCoeff());
        }
      };
      alike();
      run(*cpu, 15, 0.01);
      run(*gpu, 15, 0.01);
      alike();
      agree_in_coefficients(fmt::format("albedo, {}, {} dimensions", variant, dimensions), *cpu, *gpu,
                            {variant == std::string("galerkin") ? 1e-5 : 1e-10, 2e-5});
      gpu->restore(cpu->state());
      alike();
    }
}

DEVICE_TEST_CASE("legendre fluids on the device: wind through the sides is the CPU's",
                 "[gpu][legendre_fluids][thorough]") {
  using Kind = scene::Side::Kind;
  struct Case {
    int dimensions;
    const char* n;
    scene::StartVelocity velocity;
    bool stays;
  };
  const scene::Wind along{Vec3(1, 0, 0), Vec3(0.5, 0, 0), 1.5}, oblique{Vec3(0.6, -0.8, 0), Vec3(0.2, 0.1, 0), 1},
      up{Vec3(0, 0.3, -0.7)};
  for (const Case& c : {Case{2, "7", along, false}, Case{2, "12", oblique, false}, Case{3, "6", oblique, false},
                        Case{3, "8", up, false}, Case{3, "5", up, true}, Case{2, "8", scene::RigidRotation{}, true},
                        Case{3, "6", scene::RigidRotation{Point3(1.3, 2.2, 0.4), Vec3(1, 2, -1.5)}, true}}) {
    FlowProblem problem = everything(c.dimensions);
    problem.velocity = c.velocity;
    problem.velocity_stays = c.stays;
    const auto* wind = std::get_if<scene::Wind>(&c.velocity);
    for (int a = 0; a < c.dimensions; ++a)
      for (int side = 0; side < 2; ++side) {
        scene::Side& s = problem.sides[std::size_t(a)][std::size_t(side)];
        if (wind && (wind->velocity[a] != 0 || wind->gust[a] != 0)) s.kind = Kind::open;
        s.density = 0.3 + 0.1 * a + 0.2 * side, s.temperature = 5 - side, s.of = side;
      }
    const Given settings{{"n", c.n}, {"filter_velocity", "0.5"}, {"filter_carried", "1"}};
    const auto cpu = start<legendre_fluids::LegendreFluids>(problem, settings), gpu = on_device(problem, settings);
    run(*cpu, 20, 0.02);
    run(*gpu, 20, 0.02);
    agree_in_coefficients(fmt::format("wind, {} dimensions, n = {}, stays {}", c.dimensions, c.n, c.stays), *cpu, *gpu,
                          {2e-6, 2e-5});
    CHECK(gpu->counters().at("Runge-Kutta steps") == cpu->counters().at("Runge-Kutta steps"));
    const Difference d = difference(*gpu, *cpu, problem);
    CHECK(std::max({d.velocity, d.density, d.temperature}) < 2e-5);
  }
}

// Closed forms: what comes in fills the box; a blob goes as far as the integral of the gust.
DEVICE_TEST_CASE("legendre fluids on the device: wind blows a box clean, and brings what comes in",
                 "[gpu][legendre_fluids]") {
  FlowProblem problem = box(2, Vec3(2, 1, 1));
  problem.velocity = scene::Wind{Vec3(1, 0, 0)};
  for (scene::Side& side : problem.sides[0]) side.kind = scene::Side::Kind::open;
  problem.density = 1;
  problem.sides[0][0].density = 0.25;
  auto flow = on_device(problem, {{"n", "8"}});
  run(*flow, 60, 0.1);
  CHECK(flow->totals().mass == Approx(0.5).epsilon(1e-3));
  CHECK((flow->velocity(Point3(1.3, 2.2, 0)) - Vec3(1, 0, 0)).norm() < 1e-6);
  problem = box(2, Vec3(4, 1, 1));
  problem.velocity = scene::Wind{Vec3(0.5, 0, 0), Vec3(1, 0, 0), 0.25};
  for (scene::Side& side : problem.sides[0]) side.kind = scene::Side::Kind::open;
  problem.blobs.push_back({problem.box.lo + Vec3(1.2, 0.5, 0), 0.45, 1, 0});
  flow = on_device(problem, {{"n", "16"}});
  run(*flow, 60, 0.02);
  const double t = 1.2, way = 0.5 * t + (1 - std::cos(pi / 2 * t)) / (pi / 2);
  CHECK(flow->totals().center_of_mass[0] == Approx(problem.box.lo[0] + 1.2 + way).margin(2e-2));
}

DEVICE_TEST_CASE("legendre fluids on the device: 500 steps keep energy and stay without divergence",
                 "[gpu][legendre_fluids][slow][thorough]") {
  using namespace legendre_fluids;
  const std::pair<int, int> cases[] = {{2, 8}, {2, 16}, {3, 8}};
  for (const auto& [dimensions, n] : cases) {
    ConfinedFluid fluid(dimensions, n, Vec3::Ones(), {}, {});
    fluid.velocity = testing::swirl(fluid.space());
    const double before = fluid.energy();
    gpu::legendre_fluids::ConfinedFluidOnDevice device(gpu::Context::get(), fluid, {}, {});
    for (int i = 0; i < 500; ++i) device.step(0.02);
    device.download(fluid);
    CAPTURE(dimensions, n);
    CHECK(device.substeps() == 500);
    CHECK(std::abs(fluid.energy() / before - 1) < 1e-5);  // measured 9e-7, 2e-7, 3.7e-6
    CHECK(fluid.space().divergence(fluid.velocity).cwiseAbs().maxCoeff() < 5e-6);
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: a warm step sends nothing and waits once", "[gpu][legendre_fluids]") {
  FlowProblem problem = everything(3);
  problem.velocity = scene::Wind{Vec3(0, 0.3, 0)};
  for (scene::Side& side : problem.sides[1]) side.kind = scene::Side::Kind::open;
  {
    const auto blown = on_device(problem, {{"n", "4"}});
    gpu::Traffic& traffic = gpu::Context::get().traffic();
    run(*blown, 2, 0.01);
    const gpu::Traffic before = traffic;
    run(*blown, 10, 0.01);
    const gpu::Traffic warm = traffic - before;
    CHECK(warm.bytes_up == 0);
    CHECK(warm.syncs == 10);
    CHECK(warm.allocations == 0);
  }
  problem = everything(3);
  const auto flow = on_device(problem, {{"n", "6"}});
  gpu::Traffic& traffic = gpu::Context::get().traffic();
  run(*flow, 2, 0.02);
  gpu::Traffic before = traffic;
  run(*flow, 10, 0.02);
  gpu::Traffic warm = traffic - before;
  CHECK(warm.bytes_up == 0);
  CHECK(warm.bytes_down == 80);
  CHECK(warm.syncs == 10);
  CHECK(warm.allocations == 0);
  CHECK(warm.program_look_ups == 0);
  CHECK(warm.dispatches <= 300);
  // Results that are asked for are downloaded once.
  before = traffic;
  flow->totals();
  flow->velocity(problem.box.lo);
  flow->frame();
  warm = traffic - before;
  CHECK(warm.syncs == 1);
  CHECK(warm.bytes_down == 6 * 6 * 6 * 6 * 4);
  CHECK(warm.bytes_up == 0);
}

DEVICE_TEST_CASE("legendre fluids on the device: restart gives the same bits", "[gpu][legendre_fluids]") {
  const Given settings{{"n", "6"}, {"filter_carried", "1"}};
  const auto whole = on_device(everything(3), settings), again = on_device(everything(3), settings);
  run(*whole, 4, 0.02);
  again->restore(whole->state());
  run(*whole, 4, 0.02);
  run(*again, 4, 0.02);
  CHECK(whole->state() == again->state());
}

DEVICE_TEST_CASE("legendre fluids on the device: extremes of viscosity, steps and speed",
                 "[gpu][legendre_fluids][thorough]") {
  FlowProblem problem = box(3);
  problem.velocity = scene::Swirl{1};
  problem.density = 1;
  for (const char* n : {"2", "3", "7", "16"}) {
    CAPTURE(n);
    problem.viscosity = 1e6;  // times a step of 1 s in a box of 1 m
    auto flow = on_device(problem, {{"n", n}});
    flow->step(1);
    CHECK(flow->totals().energy == 0);
    CHECK(flow->totals().mass == Approx(1).epsilon(1e-5));
    problem.viscosity = 0;
    flow = on_device(problem, {{"n", n}});
    const double energy = flow->totals().energy;
    run(*flow, 5, 1e-4);
    CHECK(flow->totals().energy == Approx(energy).epsilon(1e-5));
    CHECK(flow->totals().density_least == Approx(1).epsilon(1e-5));
  }
  problem.velocity = scene::Swirl{10};
  const auto fast = on_device(problem, {{"n", "8"}}),
             same = start<legendre_fluids::LegendreFluids>(problem, {{"n", "8"}});
  fast->step(0.2), same->step(0.2);
  CHECK(same->counters().at("Runge-Kutta steps") > 5);
  CHECK(fast->counters().at("Runge-Kutta steps") == same->counters().at("Runge-Kutta steps"));
  problem.velocity = scene::Swirl{1e30};
  const auto wild = on_device(problem, {{"n", "4"}});
  const std::string before = wild->state();
  CHECK_THROWS_WITH(wild->step(1), Contains("step 1") && Contains("too much"));
  CHECK(wild->state() == before);
}

TEST_CASE("legendre fluids on the device: what shaders do not know is refused by name", "[gpu][legendre_fluids]") {
  CHECK(objections(box(3), {}).empty());
  CHECK_THAT(objections(box(3), {{"variant", "paper"}, {"n", "11"}}).at(0), Contains("paper with 1331 coefficients"));
  const Given repaired{{"variant", "paper_repaired"}, {"n", "17"}};
  CHECK(objections(box(2), repaired).empty());
  CHECK_THAT(objections(box(3), repaired).at(0), Contains("paper_repaired with 4913 coefficients"));
  CHECK_THAT(objections(box(3), {{"n", "17"}}).at(0), Contains("n = 17"));
  CHECK_THAT(objections(box(3), {{"n", "1"}}).at(0), Contains("n = 1"));
  FlowProblem problem = box(3);
  problem.confinement = 1;
  CHECK_THAT(objections(problem, {}).at(0), Contains("confinement"));
}

}  // namespace flow_test
