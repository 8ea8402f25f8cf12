// The paper's variants of the solver on the device: agreement with the CPU, what they keep and what they gain, what passes between both.
#include "gpu/legendre_fluids/paper_fluid.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/device.h"
#include "tests/gpu/legendre_fluids/flows_on_device.h"

namespace paper_fluid_on_device_test {

using namespace airlight;
using namespace gpu::test;
using Catch::Contains;
using gpu::legendre_fluids::PaperFluidOnDevice;
using legendre_fluids::Material;
using legendre_fluids::PaperFluid;
using legendre_fluids::Truncation;

namespace {

constexpr Material carries{0, 0, false};

Vec3 confined_swirl(const Vec3& x) { return {-x[1] * (1 - x[0] * x[0]), x[0] * (1 - x[1] * x[1]), 0}; }
Vec3 rotation(const Vec3& x) { return {-x[1], x[0], 0}; }

// Figure 7: a Gaussian, 144 coefficients, carried over a revolution in 200 steps. What is left of its square and of its mass.
struct Left {
  double squares, mass;
};
Left carried(Truncation truncation, const legendre_fluids::VelocityFunction& u) {
  PaperFluid fluid(2, 12, Vec3::Ones(), carries, truncation, false);
  fluid.begin(u);
  fluid.density = fluid.space().scalar_from_function(
      [](const Vec3& x) { return std::exp(-(x - Vec3(0.35, 0, 0)).squaredNorm() / (2 * 0.25 * 0.25)); });
  const Eigen::VectorXd before = fluid.density, velocity = fluid.velocity;
  PaperFluidOnDevice device(gpu::Context::get(), fluid, carries);
  for (int step = 0; step < 200; ++step) device.step(2 * pi / 200);
  device.download(fluid);
  CHECK(fluid.velocity == velocity);
  return {fluid.density.squaredNorm() / before.squaredNorm(), fluid.density[0] / before[0]};
}

FlowProblem swirl(int dimensions, double viscosity = 0) {
  FlowProblem problem = box(dimensions, Vec3::Constant(2));
  problem.velocity = scene::Swirl{1};
  problem.viscosity = viscosity;
  problem.blobs.push_back({problem.box.lo + Vec3(1.2, 1.1, dimensions == 3 ? 0.9 : 0), 0.5, 1, 0});
  return problem;
}

// Steps until the run ends, at most `most`, and the reason.
std::pair<int, std::string> run_to_the_end(scene::Flow& flow, int most, double dt) {
  for (int step = 0; step < most; ++step) try {
      flow.step(dt);
    } catch (const scene::Unstable& e) {
      return {step, e.what()};
    }
  return {most, ""};
}

}  // namespace

DEVICE_TEST_CASE("legendre fluids, paper, on the device: flows agree with the CPU after many steps",
                 "[gpu][legendre_fluids][thorough]") {
  struct Case {
    const char *variant, *truncation;
    int dimensions;
    const char* n;
    bool stays;
    int steps;
  };
  for (const Case& c :
       {Case{"paper", "chebyshev", 3, "4", false, 15}, Case{"paper", "l2", 3, "6", false, 15},
        Case{"paper", "chebyshev", 2, "8", false, 10}, Case{"paper", "l2", 2, "12", true, 40},
        Case{"paper", "chebyshev", 3, "5", true, 40}, Case{"paper_repaired", "chebyshev", 3, "6", false, 40},
        Case{"paper_repaired", "l2", 3, "8", false, 40}, Case{"paper_repaired", "l2", 2, "16", false, 40},
        Case{"paper_repaired", "chebyshev", 2, "9", true, 40}}) {
    FlowProblem problem = everything(c.dimensions);
    problem.velocity_stays = c.stays;
    if (c.variant == std::string("paper")) problem.viscosity = 1e-5, problem.diffusivity = 5e-6;
    const Given settings{{"n", c.n}, {"variant", c.variant}, {"truncation", c.truncation}};
    const auto cpu = start<legendre_fluids::LegendreFluids>(problem, settings), gpu = on_device(problem, settings);
    run(*cpu, c.steps, 0.01);
    run(*gpu, c.steps, 0.01);
    agree_in_coefficients(fmt::format("{}, {}, {} dimensions, n = {}, stays {}, {} steps", c.variant, c.truncation,
                                      c.dimensions, c.n, c.stays, c.steps),
                          *cpu, *gpu, {1e-11, 1e-10});
    CHECK(gpu->time() == cpu->time());
    CHECK(gpu->totals().mass == Approx(cpu->totals().mass).epsilon(1e-10));
  }
}

DEVICE_TEST_CASE("legendre fluids, paper, on the device: figure 7", "[gpu][legendre_fluids][slow][thorough]") {
  const Left chebyshev = carried(Truncation::chebyshev, confined_swirl), l2 = carried(Truncation::l2, confined_swirl);
  CHECK(l2.squares == Approx(1).epsilon(1e-12));
  CHECK(l2.mass == Approx(1).epsilon(1e-12));
  CHECK(chebyshev.squares == Approx(0.99976).margin(2e-5));
  CHECK(chebyshev.mass == Approx(0.99942).margin(2e-5));
  CHECK(carried(Truncation::chebyshev, rotation).squares == Approx(38).epsilon(0.03));
  CHECK(carried(Truncation::l2, rotation).squares == Approx(51).epsilon(0.03));
}

DEVICE_TEST_CASE(
    "legendre fluids, paper, on the device: a run that gains energy ends in the CPU's step, with its words",
    "[gpu][legendre_fluids]") {
  for (const char* truncation : {"chebyshev", "l2"}) {
    const Given settings{{"variant", "paper"}, {"n", "8"}, {"truncation", truncation}};
    const auto cpu = start<legendre_fluids::LegendreFluids>(swirl(2), settings), gpu = on_device(swirl(2), settings);
    const auto [steps, why] = run_to_the_end(*cpu, 1000, 0.02);
    const auto [same, reason] = run_to_the_end(*gpu, 1000, 0.02);
    CAPTURE(truncation, why, reason);
    CHECK(steps < 1000);
    CHECK(same == steps);
    CHECK(reason.substr(0, reason.find("the energy")) == why.substr(0, why.find("the energy")));
  }
}

DEVICE_TEST_CASE("legendre fluids, paper, on the device: repaired, energy falls and nothing passes the walls",
                 "[gpu][legendre_fluids]") {
  for (const int dimensions : {2, 3}) {
    const auto flow = on_device(swirl(dimensions), {{"variant", "paper_repaired"}, {"truncation", "l2"}, {"n", "6"}});
    const scene::Totals start = flow->totals();
    double before = start.energy;
    for (int step = 0; step < (dimensions == 2 ? 200 : 30); ++step) {
      flow->step(0.01);
      const double now = flow->totals().energy;
      CHECK(now <= before * (1 + 1e-12));
      before = now;
    }
    CHECK(before > 0.7 * start.energy);
    CHECK(flow->totals().mass == Approx(start.mass).epsilon(1e-12));
    CHECK(flow->totals().divergence < 1e-12);
    CHECK(std::abs(flow->velocity(Point3(3, 2.3, dimensions == 3 ? 0.7 : 0))[0]) < 1e-12);
  }
}

DEVICE_TEST_CASE("legendre fluids, paper, on the device: a warm step sends nothing and waits once",
                 "[gpu][legendre_fluids]") {
  for (const char* variant : {"paper", "paper_repaired"}) {
    FlowProblem problem = everything(3);
    if (variant == std::string("paper")) problem.viscosity = problem.diffusivity = 1e-6;
    const auto flow = on_device(problem, {{"n", "4"}, {"variant", variant}});
    gpu::Traffic& traffic = gpu::Context::get().traffic();
    run(*flow, 3, 1e-3);
    gpu::Traffic before = traffic;
    run(*flow, 10, 1e-3);
    gpu::Traffic warm = traffic - before;
    CAPTURE(variant);
    CHECK(warm.bytes_up == 0);
    CHECK(warm.bytes_down == 10 * 8 * (6 * 9 + 4));
    CHECK(warm.syncs == 10);
    CHECK(warm.allocations == 0);
    CHECK(warm.program_look_ups == 0);
    CHECK(warm.dispatches <= 50);
    before = traffic;
    flow->totals();
    flow->velocity(problem.box.lo);
    warm = traffic - before;
    CHECK(warm.syncs == 1);
    CHECK(warm.bytes_down == 6 * 4 * 4 * 4 * 8);
  }
}

DEVICE_TEST_CASE("legendre fluids, paper, on the device: restart gives the same bits", "[gpu][legendre_fluids]") {
  for (const char* variant : {"paper", "paper_repaired"}) {
    FlowProblem problem = everything(2);
    problem.viscosity = problem.diffusivity = 1e-6;
    const Given settings{{"n", "6"}, {"variant", variant}};
    const auto whole = on_device(problem, settings), again = on_device(problem, settings);
    run(*whole, 4, 0.01);
    again->restore(whole->state());
    run(*whole, 4, 0.01);
    run(*again, 4, 0.01);
    CHECK(whole->state() == again->state());
  }
}

// The outcome is the CPU's in every case: the same words, or the same coefficients.
DEVICE_TEST_CASE("legendre fluids, paper, on the device: extremes of coefficients, viscosity and steps",
                 "[gpu][legendre_fluids][slow][thorough]") {
  for (const char* variant : {"paper", "paper_repaired"})
    for (const int dimensions : {2, 3})
      for (const char* n : {"1", "2", "3", "8"})
        for (const double viscosity : {0.0, 1e-6, 1e3})
          for (const double dt : {1e-4, 10.0}) {
            if (n == std::string("8") && dt > 1) continue;  // minutes
            FlowProblem problem = swirl(dimensions, viscosity);
            problem.diffusivity = viscosity;
            const Given settings{{"n", n}, {"variant", variant}};
            const auto cpu = start<legendre_fluids::LegendreFluids>(problem, settings),
                       gpu = on_device(problem, settings);
            const auto [steps, why] = run_to_the_end(*cpu, 2, dt);
            const auto [same, reason] = run_to_the_end(*gpu, 2, dt);
            CAPTURE(variant, dimensions, n, viscosity, dt, why, reason);
            CHECK(same == steps);
            CHECK(reason.empty() == why.empty());
            if (why.empty()) CHECK(coefficient_differences(*cpu, *gpu).back() < 1e-7);
          }
  FlowProblem problem = swirl(2);
  problem.velocity = scene::Swirl{1e30};
  const auto wild = on_device(problem, {{"n", "4"}, {"variant", "paper"}});
  const std::string before = wild->state();
  CHECK_THROWS_WITH(wild->step(1), Contains("step 1") && Contains("too much for a step"));
  CHECK(wild->state() == before);
  problem = swirl(2);
  problem.blobs[0].density = std::nan("");
  const auto none = on_device(problem, {{"n", "4"}, {"variant", "paper_repaired"}});
  CHECK_THROWS_WITH(none->step(0.1), Contains("no longer finite"));
}

}  // namespace paper_fluid_on_device_test
