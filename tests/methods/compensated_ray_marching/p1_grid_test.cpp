// Diffusion on a grid: solutions in closed form that it converges to, what flows adds up to what is made, transport where it is thick.
#include "methods/compensated_ray_marching/p1_grid.h"

#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "tests/oracle_vectors.h"
#include "tests/second_opinion/diffusion_solutions.h"

namespace p1_grid_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::compensated_ray_marching;

namespace {

const std::string file = "compensated_ray_marching";
const double mean_scale = std::sqrt(4 * pi), direction_scale = std::sqrt(4 * pi / 3);
const P1Options fine{1e-12, 10000};

OrdinateGrid slab(int cells, double thickness) {
  return {{1, 1, cells}, {1, 1, thickness / cells}, {true, true, false}};
}

Diffusion diffusion_of(const json& in) {
  return {number(in.at("sigma_t")), number(in.at("albedo")), number(in.at("g"))};
}

// The largest error of the mean over a slab, relative to its greatest value.
double slab_error(const Diffusion& d, double source, double thickness, int cells) {
  Moments emitted = Moments::Zero(cells, 4);
  emitted.col(0) = mean_scale * source;
  const P1Solution s =
      P1Grid(slab(cells, thickness), Eigen::ArrayXd::Constant(cells, d.sigma_t), d.albedo, d.g, fine).solve(emitted, 2);
  double worst = 0;
  for (int i = 0; i < cells; ++i)
    worst = std::max(
        worst, std::abs(s.radiance(i, 0) / mean_scale - d.in_slab(source, thickness, (i + 0.5) * thickness / cells)));
  return worst / d.in_slab(source, thickness, thickness / 2);
}

// Something without any symmetry.
Eigen::ArrayXd uneven(const OrdinateGrid& grid) {
  Eigen::ArrayXd values(grid.nodes());
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = 0.1 + double((i * 7919) % 101) / 20;
  return values;
}

}  // namespace

TEST_CASE("diffusion on a grid: slabs, to second order", "[compensated_ray_marching]") {
  for (const json& v : vectors_of(file, "diffusion_slab_marshak")) {
    const json& in = v.at("input");
    const Diffusion d = diffusion_of(in);
    const double thickness = number(in.at("thickness")), source = number(in.at("J0"));
    REQUIRE(number(in.at("D")) == 1);
    const double coarse = slab_error(d, source, thickness, 50), twice = slab_error(d, source, thickness, 100),
                 finest = slab_error(d, source, thickness, 400);
    CAPTURE(v.at("id").get<std::string>(), coarse, twice, finest);
    CHECK(twice < 0.3 * coarse);
    CHECK(finest < 1.0 / 40 * coarse);
    CHECK(finest < 1e-3);
  }
}

// For a source with a direction and without a mean the solution is odd: C sinh(s (z - T/2)), C = kappa e J1 /
// (sinh(sT/2)/2 + kappa s cosh(sT/2)).
TEST_CASE("diffusion on a grid: a source with a direction", "[compensated_ray_marching]") {
  const Diffusion d{2, 0.9, 0.4};
  const double thickness = 3, along = 0.7, s = d.sigma_eff(), half = s * thickness / 2;
  const double scale = d.kappa() * d.sigma_t * along / (0.5 * std::sinh(half) + d.kappa() * s * std::cosh(half));
  double before = 0;
  for (const int cells : {40, 80}) {
    Moments emitted = Moments::Zero(cells, 4);
    emitted.col(2) = direction_scale * along;
    emitted.col(3) = -direction_scale * 0.3;  // along x, which has no end
    const P1Solution p1 =
        P1Grid(slab(cells, thickness), Eigen::ArrayXd::Constant(cells, d.sigma_t), d.albedo, d.g, fine)
            .solve(emitted, 2);
    double worst = 0, worst_direction = 0;
    for (int i = 0; i < cells; ++i) {
      const double z = (i + 0.5) * thickness / cells, at = s * z - half;
      worst = std::max(worst, std::abs(p1.radiance(i, 0) / mean_scale - scale * std::sinh(at)));
      const double flux = d.kappa() * (d.sigma_t * along - scale * s * std::cosh(at));
      worst_direction = std::max(worst_direction, std::abs(p1.radiance(i, 2) / direction_scale - 3 * flux));
      CHECK(-p1.radiance(i, 3) / direction_scale == Approx(0.3 / (1 - d.albedo * d.g)).epsilon(1e-12));
    }
    CAPTURE(cells, worst, worst_direction);
    CHECK(worst < 1e-3 * scale * std::sinh(half));
    CHECK(worst_direction < 2e-3);
    if (before > 0) CHECK(worst < 0.3 * before);
    before = worst;
  }
}

TEST_CASE("diffusion on a grid: a point in smoke without end, an even source in it", "[compensated_ray_marching]") {
  for (const json& v : vectors_of(file, "diffusion_point_source")) {
    const json& in = v.at("input");
    const Diffusion d = diffusion_of(in);
    const double distance = number(in.at("r"));
    // A cube so large that hardly anything comes back from its faces.
    const int n = 61, middle = n / 2;
    const double cell = distance / 6, reach = std::exp(-2 * d.sigma_eff() * (middle * cell - distance));
    const OrdinateGrid grid{{n, n, n}, Vec3::Constant(cell)};
    const P1Grid p1(grid, Eigen::ArrayXd::Constant(grid.nodes(), d.sigma_t), d.albedo, d.g, {1e-9, 2000});
    Moments emitted = Moments::Zero(grid.nodes(), 1);
    emitted(middle + n * (middle + n * middle), 0) =
        mean_scale * number(in.at("power")) / (4 * pi * d.sigma_t * cell * cell * cell);
    const P1Solution s = p1.solve(emitted, 1);
    const double got = s.radiance(middle + 6 + n * (middle + n * middle), 0) / mean_scale,
                 expected = d.around_point(distance, number(in.at("power")));
    CAPTURE(v.at("id").get<std::string>(), got, expected, reach, s.iterations);
    CHECK(s.error <= 1e-9);
    // Cells are a sixth of the distance: errors of their square, more where light falls off within them.
    const double depth_of_cell = d.sigma_eff() * cell;
    CHECK(std::abs(got - expected) < (0.02 + depth_of_cell * depth_of_cell + reach) * expected);
  }
  for (const json& v : vectors_of(file, "diffusion_uniform_source")) {
    const double albedo = number(v.at("input").at("albedo")),
                 source = number(v.at("input").at("single_scatter_mean_source"));
    Moments emitted = Moments::Zero(400, 1);
    emitted.col(0) = mean_scale * source;
    const P1Solution s = P1Grid(slab(400, 400), Eigen::ArrayXd::Constant(400, 5), albedo, 0.3, fine).solve(emitted, 1);
    CHECK(s.radiance(200, 0) / mean_scale == Approx(number(v.at("expected"))).epsilon(1e-8));
  }
}

// Emitted light is absorbed or flows out, cell by cell and over the box.
TEST_CASE("diffusion on a grid: light is conserved", "[compensated_ray_marching]") {
  const OrdinateGrid grid{{6, 5, 7}, Vec3(0.3, 0.25, 0.4)};
  const Eigen::ArrayXd extinction = uneven(grid);
  const double albedo = 0.8, g = 0.3;
  Moments emitted = Moments::Zero(grid.nodes(), 1);
  emitted.col(0) = extinction.square();
  const P1Solution s = P1Grid(grid, extinction, albedo, g, fine).solve(emitted, 1);
  const Eigen::ArrayXd mean = s.radiance.col(0);
  double leaves = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (Eigen::Index i = 0; i < grid.nodes(); ++i) {
      const Eigen::Index place = std::array<Eigen::Index, 3>{i % 6, i / 6 % 5, i / 30}[std::size_t(axis)];
      const double out = mean[i] / (2 + 0.5 * grid.cell[axis] * 3 * (1 - albedo * g) * extinction[i]);
      leaves += out / grid.cell[axis] * ((place == 0) + (place + 1 == grid.size[std::size_t(axis)]));
    }
  const double made = (extinction * emitted.col(0)).sum(), absorbed = (1 - albedo) * (extinction * mean).sum();
  CHECK(absorbed + leaves == Approx(made).epsilon(1e-10));
  CHECK(leaves > 0.2 * made);
  CHECK(mean.minCoeff() > 0);
}

TEST_CASE("diffusion on a grid: deep in thick smoke it is transport", "[compensated_ray_marching]") {
  for (const json& v : vectors_of(file, "sn_slab")) {
    const json& in = v.at("input");
    if (number(in.at("emission_J0")) == 0) continue;
    const double thickness = number(in.at("optical_thickness"));
    Moments emitted = Moments::Zero(800, 1);
    emitted.col(0) = mean_scale * number(in.at("emission_J0"));
    const P1Solution s =
        P1Grid(slab(800, thickness), Eigen::ArrayXd::Ones(800), number(in.at("albedo")), number(in.at("g")), fine)
            .solve(emitted, 1);
    const double expected = number(v.at("expected").at("mean_radiance")[3]);
    REQUIRE(number(in.at("tau")[3]) == thickness / 2);
    CHECK(s.radiance(400, 0) / mean_scale == Approx(expected).epsilon(0.01));
  }
}

TEST_CASE("diffusion on a grid: iterations, starts, lights", "[compensated_ray_marching]") {
  const OrdinateGrid grid{{16, 14, 12}, Vec3::Constant(0.2)};
  Eigen::ArrayXd extinction = uneven(grid);
  for (Eigen::Index i = 0; i < extinction.size(); i += 2) extinction[i] = 0;  // a vacuum in between
  const P1Grid p1(grid, extinction, 0.97, 0.5, {1e-8, 1000});
  Moments source = Moments::Zero(grid.nodes(), 8);
  source.col(0) = source.col(6) = uneven(grid);
  source.col(4) = 2 * uneven(grid);
  const P1Solution cold = p1.solve(source, 2), warm = p1.solve(source, 2, &cold.radiance);
  CHECK(cold.error <= 1e-8);
  CHECK(cold.iterations > 4);
  CHECK(warm.iterations <= 2);
  CHECK(cold.radiance.allFinite());
  const P1Solution one = p1.solve(source.leftCols(4), 2);
  CHECK((one.radiance - cold.radiance.leftCols(4)).abs().maxCoeff() == 0);
  // A light near the one before begins nearer.
  Moments turned = source;
  turned.col(0) *= 1.01;
  CHECK(p1.solve(turned, 2, &cold.radiance).iterations < cold.iterations);
  const P1Solution few = P1Grid(grid, extinction, 0.97, 0.5, {1e-8, 3}).solve(source, 2);
  CHECK(few.iterations == 6);
  CHECK(few.error > 1e-8);
  CHECK((p1.solve(Moments::Zero(grid.nodes(), 8), 2).radiance == 0).all());
}

TEST_CASE("diffusion on a grid: extremes, and what is refused", "[compensated_ray_marching]") {
  const OrdinateGrid grid{{4, 4, 4}, Vec3::Constant(0.5)};
  const Moments source = Moments::Ones(grid.nodes(), 4);
  for (const double extinction : {0.0, 1e-6, 1e4})
    for (const double albedo : {0.0, 1.0}) {
      const P1Solution s =
          P1Grid(grid, Eigen::ArrayXd::Constant(grid.nodes(), extinction), albedo, 0.9, fine).solve(source, 2);
      CHECK(s.radiance.allFinite());
      if (extinction < 1e-5) CHECK(s.radiance.col(0).maxCoeff() < 1e-4);
    }
  const auto refused = [&](const OrdinateGrid& g, double extinction, double albedo, double cosine) {
    CHECK_THROWS_AS(P1Grid(g, Eigen::ArrayXd::Constant(64, extinction), albedo, cosine, fine), Error);
  };
  refused(grid, -1, 0.5, 0);
  refused(grid, std::nan(""), 0.5, 0);
  refused(grid, 1, 1.5, 0);
  refused(grid, 1, 0.5, 1);
  refused({{4, 4, 4}, Vec3::Zero()}, 1, 0.5, 0);
  refused({{1, 1, 1}, Vec3::Ones(), {true, true, true}}, 1, 0.5, 0);
  const P1Grid p1(grid, Eigen::ArrayXd::Ones(64), 0.5, 0, fine);
  CHECK_THROWS_AS(p1.solve(Moments::Zero(63, 4), 2), Error);
  CHECK_THROWS_AS(p1.solve(Moments::Zero(64, 5), 2), Error);
  CHECK_THROWS_AS(p1.solve(Moments::Constant(64, 4, infinity), 2), Error);
}

}  // namespace p1_grid_test
