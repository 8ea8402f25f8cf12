// Operators of the confined space against the oracle vectors, and the identities that make it stable.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/legendre_fluids/time_steps.h"
#include "tests/methods/legendre_fluids/vectors.h"

using namespace airlight;
using namespace airlight::legendre_fluids;
using namespace airlight::legendre_fluids::testing;
using Diffusion = ConfinedSpace::Diffusion;

namespace {

constexpr double gate = 1e-12;
std::vector<json> vectors(const std::string& kind) { return test::vectors_of("legendre_fluids", kind); }

Array acceleration(const ConfinedSpace& space, const Array& u) {
  return space.project(space.advected(space.at_points(u), u));
}

}  // namespace

TEST_CASE("legendre fluids: projections of the oracle vectors", "[legendre_fluids]") {
  for (const json& v : vectors("project")) {
    CAPTURE(v["id"]);
    const ConfinedSpace space = space_of(v);
    const Array u = velocity(v), projected = space.project(u);
    CHECK(error(space.divergence(u), scalar(v["div_before"])) < gate);
    CHECK(error(projected, velocity(v, "", "_proj")) < gate);
    CHECK(space.divergence(projected).cwiseAbs().maxCoeff() < 1e-13);
    CHECK(error(space.project(projected), projected) < gate);
    CHECK(0.5 * space.inner(u, u) == Approx(test::number(v["energy_before"])).epsilon(gate));
    CHECK(0.5 * space.inner(projected, projected) == Approx(test::number(v["energy_after"])).epsilon(gate));
    CHECK(std::abs(space.inner(projected, u - projected)) < gate);
  }
}

TEST_CASE("legendre fluids: advection of the oracle vectors", "[legendre_fluids]") {
  for (const json& v : vectors("advect")) {
    CAPTURE(v["id"]);
    const ConfinedSpace space = space_of(v);
    const Array u = velocity(v), w = v.contains("w_a") ? velocity(v, "w_") : u;
    const Array rate = space.advected(space.at_points(w), u), projected = space.project(rate);
    CHECK(error(rate, velocity(v, "rhs_unprojected_")) < gate);
    CHECK(error(projected, velocity(v, "rhs_")) < gate);
    CHECK(std::abs(space.inner(u, projected)) < gate);
  }
}

TEST_CASE("legendre fluids: diffusion of the oracle vectors", "[legendre_fluids]") {
  for (const json& v : vectors("diffuse")) {
    CAPTURE(v["id"]);
    const ConfinedSpace space = space_of(v);
    const Array u = velocity(v);
    const double amount = test::number(v["nu_dt"]);
    CHECK(error(space.diffused(u, amount), velocity(v, "exp_")) < gate);
    CHECK(error(space.diffused(u, amount, Diffusion::backward_euler), velocity(v, "implicit_")) < gate);
  }
}

TEST_CASE("legendre fluids: Runge-Kutta steps of the oracle vectors", "[legendre_fluids]") {
  for (const json& v : vectors("rk4")) {
    CAPTURE(v["id"]);
    const ConfinedSpace space = space_of(v);
    const Array next =
        runge_kutta_4(velocity(v), test::number(v["dt"]), [&](const Array& u) { return acceleration(space, u); });
    CHECK(error(next, velocity(v, "", "_1")) < gate);
    CHECK(0.5 * space.inner(next, next) == Approx(test::number(v["energy_after"])).epsilon(gate));
  }
}

TEST_CASE("legendre fluids: densities of the oracle vectors", "[legendre_fluids]") {
  for (const json& v : vectors("density-advect")) {
    CAPTURE(v["id"]);
    const ConfinedSpace space = space_of(v);
    const Components w = space.at_points(velocity(v));
    const auto rate = [&](const Array& r) { return space.scalar_advected(w, r); };
    const Array r = scalar(v["r"]), next = runge_kutta_4(r, test::number(v["dt"]), rate);
    CHECK(error(rate(r), scalar(v["rhs"])) < gate);
    CHECK(error(next, scalar(v["r_1"])) < gate);
    CHECK(std::abs(rate(r)[0]) < 1e-15);
    CHECK(std::abs(rate(r).dot(r)) < 1e-14);
  }
}

TEST_CASE("legendre fluids: the energy identity of the oracle vectors", "[legendre_fluids]") {
  for (const json& v : vectors("energy-identity")) {
    const ConfinedSpace space = space_of(v);
    const Array u = velocity(v), w = velocity(v, "w_"), r = scalar(v["r"]), flat = space.project(w);
    const auto number = [&](const char* key) { return Approx(test::number(v[key])).epsilon(gate); };
    CHECK(0.5 * space.inner(w, w) == number("energy_w"));
    CHECK(-space.inner(u, space.advected(space.at_points(w), u)) == number("w_grad_u_dot_u"));
    const Array moved = space.scalar_advected(space.at_points(w), r);
    CHECK(-moved.dot(r) == number("w_grad_r_times_r"));
    CHECK(-moved[0] * std::pow(2, 1.5) == number("w_grad_r_integral"));
    CHECK(0.5 * space.inner(flat, flat) == number("w_projected_energy"));
    CHECK(std::abs(space.inner(u, space.advected(space.at_points(flat), u))) < gate);
    // Free-slip diffusion takes energy at viscosity times the integral of |grad u|^2.
    const double amount = 1e-7;
    const Array after = space.diffused(u, amount);
    CHECK(0.5 * (space.inner(u, u) - space.inner(after, after)) / amount ==
          Approx(test::number(v["gradient_energy_u"])).epsilon(1e-4));
  }
}

TEST_CASE("legendre fluids: fields and points of the oracle vectors", "[legendre_fluids]") {
  for (const json& v : vectors("evaluate")) {
    const ConfinedSpace space = space_of(v);
    const Array u = velocity(v), r = scalar(v["r"]);
    for (const json& point : v["points"]) {
      CAPTURE(point.dump());
      const Vec3 x = test::vec(point["x"]);
      const Components at{Array::Constant(1, x[0]), Array::Constant(1, x[1]), Array::Constant(1, x[2])};
      CHECK(space.scalar_sampled(r, at)[0] == Approx(test::number(point["r"])).epsilon(gate));
      for (int a = 0; a < 3; ++a) {
        CHECK(space.sampled(u, a, at)[0] == Approx(test::number(point["u"][a])).epsilon(gate).margin(gate));
        for (int q = 0; q < 3; ++q)
          CHECK(space.sampled_slope(u, a, q, at)[0] ==
                Approx(test::number(point["grad_u"][a][q])).epsilon(gate).margin(gate));
      }
    }
  }
}

TEST_CASE("legendre fluids: the projection holds in boxes that are no cubes, up to 32 coefficients",
          "[legendre_fluids]") {
  for (const int n : {1, 2, 5, 16, 32}) {
    const ConfinedSpace space(2, n, Vec3(0.5, 2, 1));
    Array u(space.size());
    for (Eigen::Index i = 0; i < u.size(); ++i) u[i] = std::sin(3.7 * double(i * i) + 1);
    const Array projected = space.project(u);
    CAPTURE(n);
    if (n == 1) {
      CHECK(u.size() == 0);
      continue;
    }
    CHECK(space.divergence(projected).norm() < 1e-12 * space.divergence(u).norm());
    CHECK(std::abs(space.inner(projected, u - projected)) < 1e-11 * space.inner(u, u));
    CHECK(space.inner(projected, projected) <= space.inner(u, u));
  }
}
