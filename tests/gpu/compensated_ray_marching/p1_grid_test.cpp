// Diffusion on a grid on the device: solutions in closed form, and the processor's, whatever the grid, the light and the start.
#include "gpu/compensated_ray_marching/p1_grid.h"

#include <cmath>

#include "scene/base/error.h"
#include "tests/gpu/device.h"
#include "tests/oracle_vectors.h"
#include "tests/second_opinion/diffusion_solutions.h"

namespace p1_grid_test {

using namespace airlight;
using namespace airlight::test;
using airlight::compensated_ray_marching::Moments;
using airlight::compensated_ray_marching::OrdinateGrid;
using airlight::compensated_ray_marching::P1Grid;
using airlight::compensated_ray_marching::P1Options;
using airlight::compensated_ray_marching::P1Solution;
using gpu::compensated_ray_marching::P1GridOnDevice;
using gpu::compensated_ray_marching::Scatterer;

namespace {

const double mean_scale = std::sqrt(4 * pi), direction_scale = std::sqrt(4 * pi / 3);
const P1Options fine{1e-12, 10000};

// A system with its buffers. Extinction is 1/m times density.
class System {
 public:
  System(gpu::Context& context, const OrdinateGrid& grid, const Eigen::ArrayXd& density, const Scatterer& s, int order,
         int lights, const P1Options& options)
      : scatterer_(s),
        nodes_(grid.nodes()),
        bands_(order * order),
        context_(context),
        densities_(context, "densities", std::vector<float>(density.begin(), density.end())),
        p1_(context, grid, densities_, s, order, lights, options) {}

  // J_ss and what is scattered again, of all lights; `before`: lights that stand before them in the buffers.
  Moments solve(const Moments& source, int before = 0) {
    std::vector<float> values(std::size_t(before * bands_ * nodes_), 7.0F);
    values.insert(values.end(), source.reshaped().begin(), source.reshaped().end());
    const gpu::Buffer single(context_, "source", values), result(context_, "result", values);
    p1_.solve(single, result, before, {1, {}});
    const std::vector<float> all = result.download<float>();
    for (long i = 0; i < before * bands_ * nodes_; ++i) REQUIRE(all[std::size_t(i)] == 7.0F);
    return Eigen::Map<const Eigen::ArrayXXf>(all.data() + before * bands_ * nodes_, nodes_, source.cols())
        .cast<double>();
  }
  // What has been scattered: M_lm, of bands whose moment is not 0.
  Moments radiance(const Moments& source) {
    Moments again = solve(source) - source.cast<float>().cast<double>();
    for (Eigen::Index b = 0; b < again.cols(); ++b)
      again.col(b) /= scatterer_.albedo * (b % bands_ == 0 ? 1 : scatterer_.mean_cosine);
    return again;
  }
  const P1GridOnDevice& p1() const { return p1_; }

 private:
  Scatterer scatterer_;
  Eigen::Index nodes_, bands_;
  gpu::Context& context_;
  gpu::Buffer densities_;
  P1GridOnDevice p1_;
};

OrdinateGrid slab(int cells, double thickness) {
  return {{1, 1, cells}, {1, 1, thickness / cells}, {true, true, false}};
}

Eigen::ArrayXd uneven(const OrdinateGrid& grid) {
  Eigen::ArrayXd values(grid.nodes());
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = 0.1 + double((i * 7919) % 101) / 20;
  return values;
}

// The processor's result in the form of the device's.
Moments expected(const P1Grid& p1, const Moments& source, int order, const Scatterer& s,
                 const Moments* before = nullptr) {
  const P1Solution solution = p1.solve(source, order, before);
  const Eigen::Index bands = order * order;
  Moments all = source.cast<float>().cast<double>();
  for (Eigen::Index b = 0; b < all.cols(); ++b)
    all.col(b) += s.albedo * (b % bands == 0 ? 1 : s.mean_cosine) * solution.radiance.col(b);
  return all;
}

}  // namespace

DEVICE_TEST_CASE("diffusion on a grid on the device: slabs, to second order", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  for (const json& v : vectors_of("compensated_ray_marching", "diffusion_slab_marshak")) {
    const json& in = v.at("input");
    const Diffusion d{number(in.at("sigma_t")), number(in.at("albedo")), number(in.at("g"))};
    const double thickness = number(in.at("thickness")), source = number(in.at("J0"));
    double before = 0;
    for (const int cells : {50, 100, 400}) {
      Moments emitted = Moments::Zero(cells, 1);
      emitted.col(0) = mean_scale * source;
      System system(context, slab(cells, thickness), Eigen::ArrayXd::Ones(cells), {d.sigma_t, d.albedo, d.g}, 1, 1,
                    fine);
      const Moments radiance = system.radiance(emitted);
      double worst = 0;
      for (int i = 0; i < cells; ++i)
        worst = std::max(
            worst, std::abs(radiance(i, 0) / mean_scale - d.in_slab(source, thickness, (i + 0.5) * thickness / cells)));
      worst /= d.in_slab(source, thickness, thickness / 2);
      CAPTURE(v.at("id").get<std::string>(), cells, worst, before);
      if (before > 0) CHECK(worst < (cells == 100 ? 0.3 : 1.0 / 12) * before);
      before = worst;
    }
    CHECK(before < 1e-3);
  }
}

// C sinh(s (z - T/2)): tests/methods/compensated_ray_marching/p1_grid_test.cpp.
DEVICE_TEST_CASE("diffusion on a grid on the device: a source with a direction", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const Diffusion d{2, 0.9, 0.4};
  const double thickness = 3, along = 0.7, s = d.sigma_eff(), half = s * thickness / 2;
  const double scale = d.kappa() * d.sigma_t * along / (0.5 * std::sinh(half) + d.kappa() * s * std::cosh(half));
  const int cells = 80;
  Moments emitted = Moments::Zero(cells, 4);
  emitted.col(2) = direction_scale * along;
  emitted.col(3) = -direction_scale * 0.3;  // along x, which has no end
  System system(context, slab(cells, thickness), Eigen::ArrayXd::Ones(cells), {d.sigma_t, d.albedo, d.g}, 2, 1, fine);
  const Moments radiance = system.radiance(emitted);
  for (int i = 0; i < cells; ++i) {
    const double z = (i + 0.5) * thickness / cells, at = s * z - half;
    CHECK(std::abs(radiance(i, 0) / mean_scale - scale * std::sinh(at)) < 3e-4 * scale * std::sinh(half));
    const double flux = d.kappa() * (d.sigma_t * along - scale * s * std::cosh(at));
    CHECK(std::abs(radiance(i, 2) / direction_scale - 3 * flux) < 5e-4);
    CHECK(-radiance(i, 3) / direction_scale == Approx(0.3 / (1 - d.albedo * d.g)).epsilon(1e-5));
  }
}

DEVICE_TEST_CASE("diffusion on a grid on the device: the processor's solution", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const std::vector<OrdinateGrid> grids{{{16, 14, 12}, Vec3::Constant(0.2)},
                                        {{7, 5, 3}, Vec3(0.3, 0.25, 0.4)},
                                        {{1, 1, 1}, Vec3::Ones()},
                                        {{1, 9, 4}, Vec3(2, 0.3, 0.2), {true, false, false}},
                                        {{33, 1, 1}, Vec3(0.1, 1, 3)}};
  for (const OrdinateGrid& grid : grids)
    for (const int order : {1, 2, 3}) {
      Eigen::ArrayXd density = uneven(grid);
      for (Eigen::Index i = 0; i < density.size(); i += 2) density[i] = 0;  // a vacuum in between
      if (grid.nodes() == 1) density[0] = 2;
      const Scatterer s{1.7, 0.97, 0.5};
      const Eigen::Index bands = order * order;
      Moments source = Moments::Zero(grid.nodes(), 2 * bands);
      for (Eigen::Index b = 0; b < source.cols(); ++b)
        source.col(b) = (b % bands == 0 ? 1 : std::cos(double(3 * b))) * uneven(grid).pow(1 + 0.1 * double(b));
      const P1Grid on_cpu(grid, s.sigma_t * density.cast<float>().cast<double>(), s.albedo, s.mean_cosine, fine);
      const Moments truth = expected(on_cpu, source.cast<float>().cast<double>(), order, s);
      System system(context, grid, density, s, order, 2, fine);
      for (const int before : {0, 1}) {
        const Moments got = system.solve(source, before);
        CAPTURE(grid.size[0], grid.size[1], grid.size[2], order, before, system.p1().iterations());
        CHECK(system.p1().error() <= fine.tolerance);
        CHECK((got - truth).abs().maxCoeff() < 3e-7 * truth.abs().maxCoeff());
      }
    }
}

DEVICE_TEST_CASE("diffusion on a grid on the device: iterations, starts, lights", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const OrdinateGrid grid{{16, 14, 12}, Vec3::Constant(0.2)};
  Eigen::ArrayXd density = uneven(grid);
  for (Eigen::Index i = 0; i < density.size(); i += 2) density[i] = 0;
  const Scatterer s{1, 0.97, 0.5};
  Moments source = Moments::Zero(grid.nodes(), 8);
  source.col(0) = source.col(6) = uneven(grid);
  source.col(4) = 2 * uneven(grid);
  System system(context, grid, density, s, 2, 2, {1e-8, 1000});
  const Moments cold = system.solve(source);
  const int from_nothing = system.p1().iterations();
  CHECK(from_nothing > 4);
  CHECK(system.p1().error() <= 1e-8);
  CHECK((system.solve(source) - cold).abs().maxCoeff() <= 1e-6 * cold.abs().maxCoeff());
  CHECK(system.p1().iterations() <= 2);
  Moments turned = source;
  turned.col(0) *= 1.01;
  system.solve(turned);
  CHECK(system.p1().iterations() > 2);
  CHECK(system.p1().iterations() < from_nothing);
  // The dark scatters nothing, and the next light begins with nothing.
  const Moments dark = Moments::Zero(grid.nodes(), 8);
  CHECK((system.solve(dark) == 0).all());
  CHECK(system.p1().iterations() == 0);
  CHECK(system.p1().error() == 0);
  CHECK((system.solve(source) == cold).all());
  CHECK(system.p1().iterations() == from_nothing);
  // One of the lights alone, and bit by bit the same.
  System alone(context, grid, density, s, 2, 1, {1e-8, 1000});
  CHECK((alone.solve(source.leftCols(4)) == cold.leftCols(4)).all());
  System few(context, grid, density, s, 2, 2, {1e-8, 3});
  few.solve(source);
  CHECK(few.p1().iterations() == 6);
  CHECK(few.p1().error() > 1e-8);
}

DEVICE_TEST_CASE("diffusion on a grid on the device: extremes", "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  const OrdinateGrid grid{{4, 4, 4}, Vec3::Constant(0.5)};
  const Moments source = Moments::Ones(grid.nodes(), 4);
  for (const double extinction : {0.0, 1e-6, 1e4})
    for (const double albedo : {0.0, 1.0}) {
      System system(context, grid, Eigen::ArrayXd::Constant(grid.nodes(), extinction), {1, albedo, 0.9}, 2, 1, fine);
      const Moments all = system.solve(source);
      CHECK(all.allFinite());
      if (albedo == 0) CHECK((all == source).all());
      if (extinction < 1e-5) CHECK((all.col(0) - 1).maxCoeff() < 1e-4);
    }
  const gpu::Buffer densities(context, "densities", 4);
  CHECK_THROWS_AS(P1GridOnDevice(context, {{1, 1, 1}, Vec3::Ones(), {true, true, true}}, densities, {}, 1, 1, fine),
                  Error);
}

}  // namespace p1_grid_test
