// Energy over many steps, and Taylor-Green.
#include "methods/legendre_fluids/time_steps.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/methods/legendre_fluids/swirl.h"

namespace time_steps_test {

using namespace airlight;
using namespace airlight::legendre_fluids;
using namespace airlight::legendre_fluids::testing;

namespace {

Array acceleration(const ConfinedSpace& space, const Array& u) {
  return space.project(space.advected(space.at_points(u), u));
}

}  // namespace

TEST_CASE("legendre fluids: Runge-Kutta keeps the energy within the step rule", "[legendre_fluids]") {
  for (const auto& [d, n] : std::vector<std::pair<int, int>>{{2, 6}, {2, 8}, {2, 12}, {2, 16}, {3, 6}}) {
    const ConfinedSpace space(d, n);
    Array u = swirl(space);
    const double before = space.inner(u, u);
    for (int step = 0; step < 1000; ++step)
      u = runge_kutta_4(u, 0.01, [&](const Array& v) { return acceleration(space, v); });
    const double drift = space.inner(u, u) / before - 1;
    CHECK(std::abs(drift) < 1e-8);
    CHECK(space.divergence(u).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("legendre fluids: Taylor-Green in a free-slip box", "[legendre_fluids]") {
  const double viscosity = 0.01, dt = 0.01;
  const auto flow = [](const Vec3& x) {
    return Vec3(std::sin(pi * x[0]) * std::cos(pi * x[1]), -std::cos(pi * x[0]) * std::sin(pi * x[1]), 0);
  };
  for (const auto& [n, bound] : std::vector<std::pair<int, double>>{{8, 4e-3}, {12, 3e-6}, {16, 5e-10}}) {
    const ConfinedSpace space(2, n);
    Array u = space.project(space.from_function(flow));
    for (int step = 0; step < 100; ++step) {
      u = space.project(space.diffused(u, 0.5 * viscosity * dt));
      u = runge_kutta_4(u, dt, [&](const Array& v) { return acceleration(space, v); });
      u = space.project(space.diffused(u, 0.5 * viscosity * dt));
    }
    const Array line = Array::LinSpaced(41, -1, 1);
    double squares = 0, all = 0;
    for (int a = 0; a < 2; ++a) {
      const Array got = space.sampled(u, a, {line, line, line});
      for (int i = 0; i < 41; ++i)
        for (int j = 0; j < 41; ++j) {
          const double exact = std::exp(-2 * pi * pi * viscosity) * flow(Vec3(line[i], line[j], 0))[a];
          squares += std::pow(got[i * 41 + j] - exact, 2);
          all += exact * exact;
        }
    }
    CHECK(std::sqrt(squares / all) < bound);
  }
}

}  // namespace time_steps_test
