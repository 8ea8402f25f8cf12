// Particles that a flow on the device carries, where it lies: known paths, agreement with the processor's, what passes between both.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/legendre_fluids/flow_particles.h"
#include "gpu/legendre_fluids/legendre_fluids.h"
#include "methods/legendre_fluids/legendre_fluids.h"
#include "scene/flow/flow_particles.h"
#include "tests/gpu/device.h"

namespace particles_test {

using namespace airlight;
using Leaving = scene::ParticleSet::Leaving;
using Given = std::map<std::string, std::string>;

namespace {

scene::FlowProblem swirl(int dimensions, int count, Leaving leaving = Leaving::stay, const Vec3& fall = Vec3::Zero()) {
  scene::FlowProblem p;
  p.dimensions = dimensions;
  p.box = {Point3(-1, -1, dimensions == 2 ? 0 : -1), Point3(1, 1, dimensions == 2 ? 0 : 1)};
  p.velocity = scene::Swirl{0.5};
  p.density = 1;
  p.particles.push_back({count, {}, 5, fall, leaving});
  return p;
}

template <class Solver>
std::unique_ptr<scene::Flow> start(const scene::FlowProblem& problem, const Given& given) {
  const Solver solver;
  return solver.start(std::make_shared<const scene::FlowProblem>(problem), scene::Settings(solver.settings(), given),
                      {});
}

// Carried by the processor's flow, from state to state.
std::vector<Point3> by_processor(const scene::FlowProblem& problem, const Given& given, int steps, double dt) {
  const auto flow = start<legendre_fluids::LegendreFluids>(problem, given),
             before = start<legendre_fluids::LegendreFluids>(problem, given);
  scene::FlowParticles particles(problem);
  for (int i = 0; i < steps; ++i) {
    flow->step(dt);
    particles.step(*before, *flow, dt, {});
    before->restore(flow->state());
  }
  return particles.positions().back();
}
std::vector<Point3> by_device(const scene::FlowProblem& problem, const Given& given, int steps, double dt) {
  const auto flow = start<gpu::legendre_fluids::LegendreFluids>(problem, given);
  scene::FlowParticles particles(problem);
  REQUIRE(particles.ride(*flow));
  for (int i = 0; i < steps; ++i) {
    flow->step(dt);
    particles.step(dt);
  }
  return particles.positions().back();
}

double greatest(const std::vector<Point3>& a, const std::vector<Point3>& b) {
  double most = 0;
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

double psi(const Point3& x) { return 0.5 * (1 - x[0] * x[0]) * (1 - x[1] * x[1]); }

}  // namespace

DEVICE_TEST_CASE("particles on the device stay on their stream lines to the fourth order of the step",
                 "[gpu][legendre_fluids][particles]") {
  // u = (-y (1 - x^2), x (1 - y^2)): phi_1 = sqrt(3/2) (x^2 - 1) / 2.
  legendre_fluids::ConfinedFluid fluid(2, 4, Vec3::Ones(), {0, 0, false}, {});
  legendre_fluids::Components parts;
  for (int a = 0; a < 2; ++a) parts[a] = Eigen::VectorXd::Zero(fluid.space().component(fluid.velocity, a).size());
  parts[0][1] = 4.0 / 3;   // of phi_1(x) L_1(y)
  parts[1][3] = -4.0 / 3;  // of L_1(x) phi_1(y)
  fluid.velocity = fluid.space().joined(parts);
  const scene::FlowProblem problem = swirl(2, 300);
  const scene::FlowParticles start(problem);
  const auto drift = [&](double dt) {
    gpu::legendre_fluids::ConfinedFluidOnDevice device(gpu::Context::get(), fluid, {0, 0, false}, {});
    scene::ParticlePlaces places{start.positions(), {std::vector<double>(300)}};
    gpu::legendre_fluids::ParticlesOnDevice particles(gpu::Context::get(), device, problem, places);
    for (int i = 0; i < std::lround(20 / dt); ++i) {
      device.step(dt);
      particles.step(dt);
    }
    particles.read(places);
    double most = 0;
    for (std::size_t i = 0; i < 300; ++i)
      most = std::max(most, std::abs(psi(places.positions[0][i]) - psi(start.positions()[0][i])));
    return most;
  };
  const double coarse = drift(0.4), middle = drift(0.2), fine = drift(0.1);
  CAPTURE(coarse, middle, fine);
  if (std::getenv("AIRLIGHT_TEST_FIGURES")) fmt::print("psi drifts by {:.1e} {:.1e} {:.1e}\n", coarse, middle, fine);
  CHECK(coarse < 1e-3);
  CHECK(std::log2(coarse / middle) > 3.7);
  CHECK(std::log2(middle / fine) > 3.7);
}

DEVICE_TEST_CASE("particles on the device go where the processor's do", "[gpu][legendre_fluids][particles][thorough]") {
  for (const int dimensions : {2, 3})
    for (const Leaving leaving : {Leaving::stay, Leaving::wrap, Leaving::respawn})
      for (const char* n : {"3", "6", "16"}) {
        scene::FlowProblem problem = swirl(dimensions, 40, leaving, Vec3(0.1, -0.7, dimensions == 2 ? 0 : 0.3));
        problem.particles.insert(problem.particles.begin(), {7, {}, 0xdeadbeef, Vec3::Zero(), Leaving::stay});
        problem.gravity = Vec3(0, -9.81, 0);
        problem.expansion = 1.0 / 300;
        problem.blobs.push_back({Point3(0.2, -0.3, 0), 0.6, 1, 30});
        problem.viscosity = 1e-3;
        const int steps = dimensions == 3 && n == std::string("16") ? 4 : 12;
        const double error =
            greatest(by_device(problem, {{"n", n}}, steps, 0.2), by_processor(problem, {{"n", n}}, steps, 0.2));
        CAPTURE(dimensions, int(leaving), n, error);
        CHECK(error < 2e-5);
        if (std::getenv("AIRLIGHT_TEST_FIGURES"))
          fmt::print("{} dimensions, n = {}, leaving {}: {:.1e}\n", dimensions, n, int(leaving), error);
      }
}

DEVICE_TEST_CASE("particles on the device go where the processor's do: the paper's variants, and a wind",
                 "[gpu][legendre_fluids][particles]") {
  for (const int dimensions : {2, 3}) {
    for (const char* variant : {"paper", "paper_repaired"}) {
      const Given given{{"n", "5"}, {"variant", variant}};
      const scene::FlowProblem problem = swirl(dimensions, 40, Leaving::wrap, Vec3(0.1, -0.7, 0));
      const double error = greatest(by_device(problem, given, 6, 0.02), by_processor(problem, given, 6, 0.02));
      CAPTURE(dimensions, variant, error);
      CHECK(error < 2e-6);
    }
    scene::FlowProblem problem = swirl(dimensions, 40, Leaving::respawn);
    problem.velocity = scene::Wind{Vec3(0.5, 0, 0), Vec3(1, 0, 0), 0.7};
    for (scene::Side& side : problem.sides[0]) side.kind = scene::Side::Kind::open;
    problem.gravity = Vec3(0, -9.81, 0);
    problem.weight = 0.02;
    problem.blobs.push_back({Point3(0.2, -0.3, 0), 0.6, 1, 0});
    const Given given{{"n", "6"}};
    const double error = greatest(by_device(problem, given, 12, 0.1), by_processor(problem, given, 12, 0.1));
    CAPTURE(dimensions, error);
    CHECK(error < 2e-5);
  }
}

DEVICE_TEST_CASE("particles on the device never leave the box", "[gpu][legendre_fluids][particles][thorough]") {
  scene::FlowProblem problem = swirl(3, 200);
  problem.velocity = scene::Swirl{30};
  for (const Point3& x : by_device(problem, {{"n", "6"}}, 10, 0.3)) REQUIRE(x.cwiseAbs().maxCoeff() <= 1);
}

DEVICE_TEST_CASE("particles on the device move without the processor, and go on from a state",
                 "[gpu][legendre_fluids][particles]") {
  const scene::FlowProblem problem = swirl(3, 3000, Leaving::respawn, Vec3(0, -0.5, 0));
  const auto flow = start<gpu::legendre_fluids::LegendreFluids>(problem, {{"n", "6"}});
  scene::FlowParticles particles(problem);
  REQUIRE(particles.ride(*flow));
  gpu::Traffic& traffic = gpu::Context::get().traffic();
  const auto run = [&](scene::Flow& f, scene::FlowParticles& p) {
    for (int i = 0; i < 4; ++i) {
      f.step(0.05);
      p.step(0.05);
    }
  };
  run(*flow, particles);
  gpu::Traffic before = traffic;
  run(*flow, particles);
  gpu::Traffic warm = traffic - before;
  CHECK(warm.bytes_down == 4 * 8);  // the status of a step
  CHECK(warm.bytes_up == 0);
  CHECK(warm.allocations == 0);
  CHECK(warm.program_look_ups == 0);
  before = traffic;
  const std::string state = particles.state();
  particles.csv();
  warm = traffic - before;
  CHECK(warm.bytes_down == 3000 * 32);
  CHECK(warm.syncs == 1);
  const auto other = start<gpu::legendre_fluids::LegendreFluids>(problem, {{"n", "6"}});
  scene::FlowParticles same(problem);
  REQUIRE(same.ride(*other));
  same.restore(state);
  other->restore(flow->state());
  run(*flow, particles);
  run(*other, same);
  CHECK(same.state() == particles.state());
  CHECK_FALSE(same.ride(*start<legendre_fluids::LegendreFluids>(problem, {{"n", "6"}})));
}

}  // namespace particles_test
