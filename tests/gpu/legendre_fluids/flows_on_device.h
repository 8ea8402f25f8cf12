// Whole flows on the device for tests, and how far their coefficients are from the CPU's.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "gpu/legendre_fluids/legendre_fluids.h"
#include "methods/legendre_fluids/legendre_fluids.h"
#include "scene/base/saved_state.h"
#include "tests/gpu/p99.h"

namespace airlight::gpu::test {

using scene::FlowProblem;
using Given = std::map<std::string, std::string>;

template <class Solver>
std::unique_ptr<scene::Flow> start(const FlowProblem& problem, const Given& settings) {
  const Solver solver;
  return solver.start(std::make_shared<const FlowProblem>(problem), scene::Settings(solver.settings(), settings), {});
}
inline std::unique_ptr<scene::Flow> on_device(const FlowProblem& problem, const Given& settings) {
  return start<gpu::legendre_fluids::LegendreFluids>(problem, settings);
}

inline FlowProblem box(int dimensions, const Vec3& size = Vec3::Ones()) {
  FlowProblem problem;
  problem.dimensions = dimensions;
  problem.box = {Point3(1, 2, 0), Point3(1 + size[0], 2 + size[1], dimensions == 2 ? 0 : size[2])};
  return problem;
}

// All there is: both scalars, buoyancy of both, a source and a force for a time, diffusion, decay.
inline FlowProblem everything(int dimensions) {
  FlowProblem problem = box(dimensions, Vec3(1, 1.5, 0.75));
  const Point3 middle = 0.5 * (problem.box.lo + problem.box.hi);
  problem.velocity = scene::Swirl{0.5};
  problem.gravity = Vec3(2, -9.81, 1);
  problem.expansion = 1.0 / 300;
  problem.weight = 0.02;
  problem.viscosity = 1e-3, problem.diffusivity = 5e-4, problem.decay = 0.3;
  problem.blobs.push_back({middle - Vec3(0.1, 0.3, 0), 0.3, 1, 30});
  scene::Source source;
  source.region = Box{middle - Vec3(0.3, 0.6, 0.3), middle + Vec3(0.3, 0, 0.3)};
  source.time = {0.05, 0.3};
  source.density_rate = 2, source.temperature_rate = 40;
  problem.sources.push_back(source);
  problem.densities.push_back({"dye", 0.1, {{middle + Vec3(0.2, 0.1, 0.1), 0.4, 1, 0}}, {}, nullptr});
  source.of = 1, source.time = {0.1, infinity}, source.temperature_rate = 0;
  problem.sources.push_back(source);
  scene::Push push;
  push.region = scene::Sphere{middle, 0.4};
  push.acceleration = Vec3(1, 0.5, -0.5);
  push.frequency = 2;
  problem.pushes.push_back(push);
  return problem;
}

inline void run(scene::Flow& flow, int steps, double dt) {
  for (int i = 0; i < steps; ++i) flow.step(dt);
}

// Differences of the coefficients of all fields, over the greatest one of the field.
inline std::vector<double> coefficient_differences(const scene::Flow& expected, const scene::Flow& got) {
  const std::string mine = got.state(), theirs = expected.state(), shape = theirs.substr(0, theirs.find('\n'));
  scene::StateReader a(mine, shape), b(theirs, shape);
  a.array(), b.array();  // times and counts
  std::vector<double> all;
  const auto add = [&] {
    const Eigen::VectorXd x = a.array(), y = b.array();
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double error = std::abs(x[i] - y[i]) / std::max(1e-300, y.cwiseAbs().maxCoeff());
      all.push_back(std::isfinite(error) ? error : infinity);
    }
  };
  // The shape names the velocity, then each array that is carried, after a comma.
  for (auto fields = std::count(shape.begin(), shape.end(), ',') - 1; fields > 0; --fields) add();
  std::sort(all.begin(), all.end());
  return all;
}

// The 99th percentile and the worst difference of coefficients. With AIRLIGHT_TEST_FIGURES they are printed.
inline void agree_in_coefficients(const std::string& name, const scene::Flow& cpu, const scene::Flow& gpu,
                                  const Bounds& bounds) {
  const std::vector<double> all = coefficient_differences(cpu, gpu);
  REQUIRE(!all.empty());
  const double usual = all[std::size_t(0.99 * double(all.size() - 1))], worst = all.back();
  CAPTURE(name, usual, worst);
  CHECK(usual < bounds.p99);
  CHECK(worst < bounds.worst);
  if (std::getenv("AIRLIGHT_TEST_FIGURES"))
    fmt::print("{}: p99 {:.1e} of {:.1e}, worst {:.1e} of {:.1e}\n", name, usual, bounds.p99, worst, bounds.worst);
}

}  // namespace airlight::gpu::test
