// The table of extremes (corrected mathematics, section 12) on the device: finite, the processor's within single precision, or refused.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "gpu/legendre_fluids/legendre_fluids.h"
#include "gpu/legendre_fluids/light.h"
#include "methods/legendre_fluids/light.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/methods/legendre_fluids/extreme_scenes.h"

namespace extremes_test {

using namespace airlight;
using namespace legendre_fluids::testing;
using Catch::Contains;

namespace {

scene::FlowProblem swirl_and_blob(int dimensions, double viscosity) {
  scene::FlowProblem problem;
  problem.dimensions = dimensions;
  const double depth = dimensions == 3 ? 1 : 0;
  problem.box = {Point3(-1, -1, -depth), Point3(1, 1, depth)};
  problem.velocity = scene::Swirl{1};
  problem.viscosity = problem.diffusivity = viscosity;
  problem.blobs.push_back({Point3(0.2, 0.1, 0), 0.5, 1, 0});
  return problem;
}

std::unique_ptr<scene::Flow> start(const scene::FlowProblem& problem, int n) {
  const gpu::legendre_fluids::LegendreFluids solver;
  return solver.start(std::make_shared<const scene::FlowProblem>(problem),
                      scene::Settings(solver.settings(), {{"n", std::to_string(n)}}), {});
}

std::string objection(int n) {
  const gpu::legendre_fluids::LegendreFluids solver;
  const auto all =
      solver.supports(swirl_and_blob(3, 0), scene::Settings(solver.settings(), {{"n", std::to_string(n)}}));
  return all.empty() ? "" : all[0];
}

}  // namespace

// dt = 10 is divided by the rule of Runge-Kutta, as on the processor; viscosity times a step up to 1e4.
DEVICE_TEST_CASE("legendre fluids on the device, extremes: no step and no viscosity makes a value that is no number",
                 "[gpu][legendre_fluids][slow][thorough]") {
  for (const int dimensions : {2, 3})
    for (const int n : {2, 3, 8, 16})
      for (const double viscosity : {0.0, 1e-12, 1e-3, 1.0, 1e3})
        for (const double dt : {1e-4, 0.1, 10.0}) {
          // Seconds on a software device: 64 parts of a step each; between the ends of viscosity.
          const bool between = viscosity > 0 && viscosity < 1e3;
          if (dimensions == 3 && ((n == 16 && (dt == 10 || between)) || (n == 8 && dt == 10 && between))) continue;
          const auto flow = start(swirl_and_blob(dimensions, viscosity), n);
          const scene::Totals before = flow->totals();
          for (int step = 0; step < (dt == 10 ? 1 : 2); ++step) flow->step(dt);
          const scene::Totals after = flow->totals();
          CAPTURE(dimensions, n, viscosity, dt);
          for (const double value : {after.energy, after.enstrophy, after.mass, after.density_least,
                                     after.density_greatest, after.greatest_speed, after.divergence})
            CHECK(std::isfinite(value));
          const double rounding = 1e-5 + 5e-6 * flow->time();  // rates are sums that cancel; measured 2e-6 a second
          CHECK(after.energy <= before.energy * (1 + rounding));
          CHECK(after.mass == Approx(before.mass).epsilon(rounding));
          if (viscosity * dt >= 1e3) CHECK(after.energy == 0);
          if (viscosity == 0 && dt == 1e-4) CHECK(after.energy == Approx(before.energy).epsilon(1e-5));
        }
}

TEST_CASE("legendre fluids on the device, extremes: counts and numbers that are none", "[gpu][legendre_fluids]") {
  CHECK_THAT(objection(1), Contains("n = 1: shaders take 2 to 16 coefficients along an axis"));
  CHECK_THAT(objection(32), Contains("n = 32: shaders take 2 to 16 coefficients along an axis"));
  for (const char* n : {"0", "-3", "2.5", "nan", "65"}) {
    const gpu::legendre_fluids::LegendreFluids solver;
    CHECK_THROWS_WITH(scene::Settings(solver.settings(), {{"n", n}}), Contains("n = ") && Contains("expected"));
  }
  if (!gpu::test::device()) return;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  scene::FlowProblem problem = swirl_and_blob(2, 0);
  problem.blobs[0].density = nan;
  auto flow = start(problem, 6);
  CHECK_THROWS_WITH(flow->step(0.1), Contains("no longer finite"));
  problem = swirl_and_blob(2, 0);
  problem.velocity = scene::Swirl{nan};
  flow = start(problem, 6);
  CHECK_THROWS_AS(flow->step(0.1), scene::Unstable);
}

// Rounding of depths: 2.5e-7 of the whole, of 24 bits (light_test.cpp).
DEVICE_TEST_CASE("legendre light on the device, extremes: every row by rays and by the paper's systems",
                 "[gpu][legendre_fluids][thorough]") {
  const legendre_fluids::LegendreLight on_cpu;
  const gpu::legendre_fluids::LegendreLight on_device;
  for (const ExtremeLight& row : extreme_lights()) {
    CAPTURE(row.row, row.depth);
    const scene::Film film = test::picture(on_device, row.scene), same = test::picture(on_cpu, row.scene);
    check_light(row, film);
    for (const char* layer : {"airlight", "transmittance"})
      CHECK(gpu::test::quantile(same, film, layer, 1) < 3.5e-6 + 2.5e-7 * row.depth);
    for (const char* closure : {"least_squares", "upwind"}) {
      CAPTURE(closure);
      check_paper_light(row, test::picture(on_device, row.scene, {{"variant", "paper"}, {"closure", closure}}));
    }
  }
  auto scene = extreme_lights()[1].scene;
  scene->media[0].field = random_density({32, 32, 32}, 1, 3);
  CHECK_THAT(on_device.supports(*scene, {on_device.settings(), {}}).at(0), Contains("32768 coefficients"));
}

}  // namespace extremes_test
