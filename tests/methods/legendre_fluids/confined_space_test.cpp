// Properties that make the confined space stable, in any box. Its numbers are those of the oracle vectors
// (experiments/verify).
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/legendre_fluids/confined_fluid.h"
#include "tests/methods/legendre_fluids/swirl.h"

namespace confined_space_test {

using namespace airlight;
using namespace airlight::legendre_fluids;
using namespace airlight::legendre_fluids::testing;
using Diffusion = ConfinedSpace::Diffusion;

namespace {

// No two of its entries are alike.
Array unlike(Eigen::Index size, double seed = 1) {
  Array u(size);
  for (Eigen::Index i = 0; i < size; ++i) u[i] = std::sin(3.7 * double(i * i) + seed);
  return u;
}

}  // namespace

TEST_CASE("legendre fluids: the projection holds in boxes that are no cubes, up to 32 coefficients",
          "[legendre_fluids]") {
  for (const int n : {1, 2, 5, 16, 32}) {
    const ConfinedSpace space(2, n, Vec3(0.5, 2, 1));
    const Array u = unlike(space.size());
    const Array projected = space.project(u);
    CAPTURE(n);
    if (n == 1) {
      CHECK(u.size() == 0);
      continue;
    }
    CHECK(space.divergence(projected).norm() < 1e-12 * space.divergence(u).norm());
    CHECK(std::abs(space.inner(projected, u - projected)) < 1e-11 * space.inner(u, u));
    CHECK(space.inner(projected, projected) <= space.inner(u, u));
    CHECK(error(space.project(projected), projected) < 1e-11);
  }
}

TEST_CASE("legendre fluids: advection is skew for any confined velocity without divergence", "[legendre_fluids]") {
  for (const int d : {2, 3}) {
    const ConfinedSpace space(d, 6, Vec3(1, 0.5, 3));
    const Array w = space.project(unlike(space.size())), u = unlike(space.size(), 2), v = unlike(space.size(), 3);
    const Components at = space.at_points(w);
    const double scale = std::abs(space.inner(u, space.advected(at, v)));
    CHECK(std::abs(space.inner(u, space.advected(at, v)) + space.inner(v, space.advected(at, u))) < 1e-11 * scale);
    const Array r = unlike(space.scalars()), moved = space.scalar_advected(at, r);
    CHECK(std::abs(moved[0]) < 1e-13 * moved.norm());
    CHECK(std::abs(moved.dot(r)) < 1e-13 * moved.norm() * r.norm());
  }
}

TEST_CASE("legendre fluids: diffusion contracts for every viscosity and keeps the mass", "[legendre_fluids]") {
  const ConfinedSpace space(2, 12, Vec3(1, 0.5, 1));
  const Array u = unlike(space.size()), r = unlike(space.scalars());
  for (const double amount : {1e-9, 1e-4, 1.0, 1e4})
    for (const Diffusion kind : {Diffusion::exact, Diffusion::backward_euler}) {
      const Array after = space.diffused(u, amount, kind), spread = space.scalar_diffused(r, amount, kind);
      CHECK(space.inner(after, after) < space.inner(u, u));
      CHECK(spread[0] == r[0]);
      CHECK(spread.norm() < r.norm());
    }
  // A mode of the box: cos(pi x / 2) from the low side on decays as it should.
  const Array wave = space.scalar_from_function([](const Vec3& x) { return std::cos(0.5 * pi * (x[0] + 1)); });
  CHECK(error(space.scalar_diffused(wave, 0.1), wave * std::exp(-0.025 * pi * pi)) < 1e-9);
}

TEST_CASE("legendre fluids: what comes in clear can only thin what is there", "[legendre_fluids]") {
  const ConfinedSpace space(3, 5);
  const Array r = unlike(space.scalars()), speed = Array::Constant(space.nodes().size() * space.nodes().size(), 0.7);
  for (int axis = 0; axis < 3; ++axis) {
    Components w;
    for (int a = 0; a < 3; ++a) w[a] = Array::Constant(space.scalar_at_points(r).size(), a == axis ? 0.7 : 0);
    const Array in = space.scalar_inflow(axis, 0, speed, r, 0), out = space.scalar_inflow(axis, 1, speed, r, 0);
    CHECK(out.norm() == 0);
    CHECK(in.dot(r) < 0);
    // d|r|^2/dt = -(integral over both sides of |w.n| r^2), half of it from inside.
    const Array rate = space.scalar_advected(w, r) + in;
    const Components ends{space.nodes(), space.nodes(), space.nodes()};
    double sides = 0;
    for (const double side : {-1.0, 1.0}) {
      Components at = ends;
      at[axis] = Array::Constant(1, side);
      const Array squares = space.scalar_sampled(r, at).cwiseAbs2();
      const Eigen::Index m = space.nodes().size();
      for (Eigen::Index i = 0; i < m; ++i)
        for (Eigen::Index j = 0; j < m; ++j) sides += space.weights()[i] * space.weights()[j] * squares[i * m + j];
    }
    CHECK(rate.dot(r) == Approx(-0.5 * 0.7 * sides).epsilon(1e-12));
  }
}

TEST_CASE("legendre fluids: filters keep the divergence and the mass", "[legendre_fluids]") {
  ConfinedOptions options;
  options.filter_velocity = options.filter_carried = 3;
  ConfinedFluid fluid(2, 8, Vec3(1, 0.5, 1), {}, options);
  fluid.velocity = fluid.space().project(unlike(fluid.space().size()));
  fluid.density = unlike(fluid.space().scalars());
  const double energy = fluid.energy(), mass = fluid.density[0];
  fluid.finish(0.1);
  CHECK(fluid.space().divergence(fluid.velocity).norm() < 1e-12);
  CHECK(fluid.density[0] == mass);
  CHECK(fluid.energy() < energy);
  CHECK(fluid.counters().at("energy filtered") == Approx(energy - fluid.energy()));
}

TEST_CASE("legendre fluids: a filter takes its rate from the highest index, and powers of the share from the others",
          "[legendre_fluids]") {
  const double rate = 3, dt = 0.1, order = 4;
  ConfinedOptions options;
  options.filter_carried = rate;
  options.filter_order = order;
  ConfinedFluid fluid(2, 8, Vec3(1, 0.5, 1), {}, options);
  fluid.density = Array::Ones(fluid.space().scalars());
  fluid.finish(dt);
  const auto left = [&](int i, int j) { return fluid.density[8 * i + j]; };
  CHECK(left(0, 0) == 1);
  CHECK(left(7, 0) == Approx(std::exp(-rate * dt)).epsilon(1e-12));
  CHECK(left(0, 7) == Approx(std::exp(-rate * dt)).epsilon(1e-12));
  const double shares = std::pow(2.0 / 7, order) + std::pow(5.0 / 7, order);
  CHECK(left(2, 5) == Approx(std::exp(-rate * dt * shares)).epsilon(1e-12));
}

}  // namespace confined_space_test
