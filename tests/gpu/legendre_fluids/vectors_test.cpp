// The fluid on the device against the oracle's vectors, in single precision: 2e-5 of the largest entry.
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/legendre_fluids/confined_fluid.h"
#include "gpu/legendre_fluids/flow_particles.h"
#include "gpu/legendre_fluids/legendre_fluids.h"
#include "tests/gpu/device.h"
#include "tests/methods/legendre_fluids/swirl.h"
#include "tests/oracle_vectors.h"

namespace vectors_test {

using namespace airlight;
using namespace airlight::legendre_fluids;
using gpu::legendre_fluids::FluidOnDevice;
using legendre_fluids::testing::error;
using test::json;

namespace {

constexpr double gate = 2e-5;

Array array_of(const json& v) { return test::Tensor(v).array(); }
Array velocity_of(const ConfinedSpace& space, const json& v, const std::string& before = "",
                  const std::string& after = "") {
  Components parts;
  for (int a = 0; a < space.dimensions(); ++a) parts[a] = array_of(v.at(before + "abc"[a] + after));
  return space.joined(parts);
}

int dimensions(const json& v) { return v.value("d", 2); }

// A fluid of the vector's velocity and density, there and back.
struct Twin {
  Twin(const json& v, const Material& material, const char* velocity = "")
      : fluid(dimensions(v), v.at("n"), Vec3::Ones(), material, {}) {
    fluid.velocity = velocity_of(fluid.space(), v, velocity);
    if (v.contains("r")) fluid.density = array_of(v.at("r"));
    device = std::make_unique<FluidOnDevice>(gpu::Context::get(), fluid, material, ConfinedOptions{});
  }
  const ConfinedSpace& space() const { return fluid.space(); }
  const Fluid& now() {
    device->download(fluid);
    return fluid;
  }
  ConfinedFluid fluid;
  std::unique_ptr<FluidOnDevice> device;
};

// The components of u, n along each axis, carried as scalars of n + 1 by a velocity w: what the device makes of each is -(w.grad) u_a in L,
// of which the test functions of u's space see all.
struct Moved {
  explicit Moved(const json& v) : n(v.at("n")), wide(3, n + 1, Vec3::Ones(), {0, 0, false}, {}) {
    const ConfinedSpace narrow(3, n, Vec3::Ones());
    const Array w = velocity_of(narrow, v, "w_"), u = velocity_of(narrow, v);
    Components parts;
    for (int a = 0; a < 3; ++a) {
      parts[a] = cut(narrow.component(w, a), narrow.shape(a), wide.space().shape(a));
      const Eigen::MatrixXd walls = scene::legendre_integral(n).rightCols(n - 1);
      Array l = scene::along_axis(a, walls, narrow.component(u, a), narrow.shape(a));
      scene::TensorShape shape{n, n, n};
      shape[std::size_t(a)] = n + 1;
      scalars.push_back(cut(l, shape, {n + 1, n + 1, n + 1}));
    }
    wide.velocity = wide.space().joined(parts);
    wide.density = scalars[0];
    wide.others = {scalars[1], scalars[2]};
    FluidOnDevice device(gpu::Context::get(), wide, {0, 0, false}, ConfinedOptions{});
    ConfinedFluid rate = wide;
    device.advect(rate);
    rates = {rate.density, rate.others[0], rate.others[1]};
  }
  // With zeros, or without what is beyond.
  static Array cut(const Array& from, const scene::TensorShape& shape, const scene::TensorShape& to) {
    const auto part = [&](std::size_t a) { return Eigen::MatrixXd(Eigen::MatrixXd::Identity(to[a], shape[a])); };
    return scene::along_axes(part(0), part(1), part(2), from, shape);
  }
  // Tested with u's space.
  Array rate_of(int a) const {
    const Eigen::MatrixXd walls = scene::legendre_integral(n).rightCols(n - 1);
    const Eigen::MatrixXd tested = (walls.transpose() * walls).llt().solve(walls.transpose());
    scene::TensorShape shape{n + 1, n + 1, n + 1}, kept{n, n, n};
    kept[std::size_t(a)] = n + 1;
    return scene::along_axis(a, tested, cut(rates[std::size_t(a)], shape, kept), kept);
  }
  int n;
  ConfinedFluid wide;
  std::vector<Array> scalars, rates;
};

}  // namespace

DEVICE_TEST_CASE("legendre fluids on the device: advection of the vectors by another velocity",
                 "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "advect")) {
    if (!v.contains("w_a")) continue;
    CAPTURE(v.at("id"));
    const Moved moved(v);
    for (int a = 0; a < 3; ++a)
      CHECK(error(moved.rate_of(a), array_of(v.at(std::string("rhs_unprojected_") + "abc"[a]))) < gate);
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: projections of the vectors", "[gpu][legendre_fluids]") {
  for (const char* kind : {"project", "coefficients"})
    for (const json& v : test::vectors_of("legendre_fluids", kind)) {
      CAPTURE(v.at("id"));
      Twin twin(v, {});
      twin.device->project();
      CHECK(error(twin.now().velocity, velocity_of(twin.space(), v, "", "_proj")) < gate);
      CHECK(twin.space().divergence(twin.fluid.velocity).cwiseAbs().maxCoeff() < 2e-6);
    }
}

DEVICE_TEST_CASE("legendre fluids on the device: advection of the vectors, before and after the projection",
                 "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "advect")) {
    if (v.contains("w_a")) continue;  // by another velocity: above
    CAPTURE(v.at("id"));
    Twin twin(v, {});
    const Array u = twin.fluid.velocity;
    ConfinedFluid rate = twin.fluid;
    twin.device->advect(rate);
    CHECK(error(rate.velocity, velocity_of(twin.space(), v, "rhs_unprojected_")) < gate);
    twin.device->upload(rate);
    twin.device->project();
    CHECK(error(twin.now().velocity, velocity_of(twin.space(), v, "rhs_")) < gate);
    const double size = twin.space().inner(u, u) * twin.space().inner(twin.fluid.velocity, twin.fluid.velocity);
    CHECK(std::abs(twin.space().inner(u, twin.fluid.velocity)) < 1e-6 * std::sqrt(size));
  }
}

DEVICE_TEST_CASE("legendre fluids on the device: diffusion and steps of the vectors", "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "diffuse")) {
    CAPTURE(v.at("id"));
    Twin twin(v, {1, 0, true});
    twin.device->diffuse(v.at("nu_dt"));
    CHECK(error(twin.now().velocity, velocity_of(twin.space(), v, "exp_")) < gate);
  }
  for (const char* kind : {"rk4", "step"})
    for (const json& v : test::vectors_of("legendre_fluids", kind)) {
      CAPTURE(v.at("id"));
      Twin twin(v, {v.value("nu", 0.0), 0, true});
      twin.device->step(v.at("dt"));
      CHECK(error(twin.now().velocity, velocity_of(twin.space(), v, "", "_1")) < gate);
      const double energy = 0.5 * twin.space().inner(twin.fluid.velocity, twin.fluid.velocity);
      CHECK(energy == Approx(test::number(v.at("energy_after"))).epsilon(1e-6));
    }
}

DEVICE_TEST_CASE("legendre fluids on the device: the density of the vectors", "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "density-advect")) {
    Twin twin(v, {0, 0, false});
    ConfinedFluid rate = twin.fluid;
    twin.device->advect(rate);
    CHECK(error(rate.density, array_of(v.at("rhs"))) < gate);
    const Array before = twin.fluid.velocity;
    twin.device->step(v.at("dt"));
    CHECK(error(twin.now().density, array_of(v.at("r_1"))) < gate);
    CHECK(error(twin.fluid.velocity, before) < 1e-7);
    CHECK(std::abs(twin.fluid.density[0] / array_of(v.at("r"))[0] - 1) < 1e-6);
  }
}

// What `w` makes of a scalar.
DEVICE_TEST_CASE("legendre fluids on the device: the form of advection, by velocities with and without divergence",
                 "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "energy-identity")) {
    Twin twin(v, {0, 0, false}, "w_");
    ConfinedFluid rate = twin.fluid;
    const Array r = array_of(v.at("r"));
    const double norm = r.norm();
    twin.device->advect(rate);
    CHECK(-rate.density.dot(r) == Approx(test::number(v.at("w_grad_r_times_r"))).margin(gate * norm));
    CHECK(-std::sqrt(8.0) * rate.density[0] == Approx(test::number(v.at("w_grad_r_integral"))).margin(gate * norm));
    const Moved moved(v);
    double transport = 0, size = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      transport -= moved.rates[a].dot(moved.scalars[a]);
      size += moved.scalars[a].squaredNorm();
    }
    CHECK(transport == Approx(test::number(v.at("w_grad_u_dot_u"))).margin(gate * size));
    twin.device->project();
    twin.device->advect(rate);
    CHECK(std::abs(rate.density.dot(r)) < gate * norm * rate.density.norm());
    CHECK(std::abs(rate.density[0]) < gate * rate.density.norm());
    const Array w = twin.now().velocity;
    CHECK(0.5 * twin.space().inner(w, w) == Approx(test::number(v.at("w_projected_energy"))).epsilon(1e-6));
  }
}

// The velocity by what it carries in a microsecond, in double precision: u dt + O(dt^2). The rest from the coefficients that come back.
DEVICE_TEST_CASE("legendre fluids on the device: values of the vectors at points, walls included",
                 "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "evaluate")) {
    CAPTURE(v.at("id"));
    Twin twin(v, {0, 0, false});
    const std::size_t count = v.at("points").size();
    scene::FlowProblem problem;
    problem.dimensions = dimensions(v);
    problem.box = {Point3::Constant(-1), Point3::Constant(1)};
    problem.particles.push_back({int(count), {}, 0, Vec3::Zero(), scene::ParticleSet::Leaving::stay});
    scene::ParticlePlaces places{{{}}, {std::vector<double>(count)}};
    std::vector<Array> u, gradient, slope;
    double most = 0, steepest = 0, steepest_r = 0;
    for (const json& point : v.at("points")) {
      const Array x = array_of(point.at("x"));
      places.positions[0].emplace_back(x[0], x[1], x.size() > 2 ? x[2] : 0);
      u.push_back(array_of(point.at("u")));
      gradient.push_back(array_of(point.at("grad_u")));
      slope.push_back(array_of(point.at("grad_r")));
      most = std::max(most, u.back().cwiseAbs().maxCoeff());
      steepest = std::max(steepest, gradient.back().cwiseAbs().maxCoeff());
      steepest_r = std::max(steepest_r, slope.back().cwiseAbs().maxCoeff());
    }
    const std::vector<Point3> from = places.positions[0];
    const double dt = 1e-6;
    gpu::legendre_fluids::ParticlesOnDevice particles(gpu::Context::get(), *twin.device, problem, places);
    twin.device->step(dt);
    particles.step(dt);
    particles.read(places);
    const Fluid& fluid = twin.now();
    const Array r = array_of(v.at("r"));  // a step of a microsecond is none, to single precision
    for (std::size_t i = 0; i < count; ++i) {
      const Components at{Array::Constant(1, from[i][0]), Array::Constant(1, from[i][1]),
                          Array::Constant(1, from[i][2])};
      const int d = dimensions(v);
      for (int a = 0; a < d; ++a) {
        CHECK((places.positions[0][i] - from[i])[a] / dt == Approx(u[i][a]).margin(gate * most).epsilon(0));
        for (int b = 0; b < d; ++b)
          CHECK(twin.space().sampled_gradient(fluid.velocity, a, b, at)[0] ==
                Approx(gradient[i][a * d + b]).margin(gate * steepest).epsilon(0));
        CHECK(twin.space().scalar_sampled_gradient(fluid.density, a, at)[0] ==
              Approx(slope[i][a]).margin(gate * steepest_r).epsilon(0));
      }
      CHECK(twin.space().scalar_sampled(fluid.density, at)[0] ==
            Approx(test::number(v.at("points")[i].at("r"))).margin(gate * r.cwiseAbs().maxCoeff()).epsilon(0));
    }
  }
}

// 16 coefficients are exact to 2e-10 at the end of it (specification, section 7): what is left is single precision.
DEVICE_TEST_CASE("legendre fluids on the device: the vortices of the vectors", "[gpu][legendre_fluids]") {
  for (const json& v : test::vectors_of("legendre_fluids", "taylor-green")) {
    CAPTURE(v.at("id"));
    auto problem = std::make_shared<scene::FlowProblem>();
    problem->dimensions = 2;
    problem->box = {Point3(-1, -1, 0), Point3(1, 1, 0)};
    problem->viscosity = v.at("nu");
    problem->velocity = scene::TaylorGreen{};
    const gpu::legendre_fluids::LegendreFluids solver;
    const auto flow = solver.start(problem, scene::Settings(solver.settings(), {{"n", "16"}}), {});
    const double t = v.at("t");
    const int steps = int(std::lround(t / 0.01));
    for (int i = 0; i < steps; ++i) flow->step(t / steps);
    const double greatest = std::exp(-2 * pi * pi * double(v.at("nu")) * t);
    for (const json& point : v.at("points")) {
      const Array x = array_of(point.at("x")), u = array_of(point.at("u"));
      const Vec3 got = flow->velocity(Point3(x[0], x[1], 0));
      for (int a = 0; a < 2; ++a) CHECK(got[a] == Approx(u[a]).margin(gate * greatest).epsilon(0));
    }
    CHECK(flow->totals().energy == Approx(test::number(v.at("energy"))).epsilon(2 * gate));  // it is quadratic
  }
}

}  // namespace vectors_test
