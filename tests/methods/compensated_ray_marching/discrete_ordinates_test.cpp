// Discrete ordinates against solutions of the transport equation: slabs, one in layers, a ball of smoke; and against what it must keep.
#include <tbb/global_control.h>

#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "scene/math/random.h"
#include "scene/math/spherical_harmonics.h"
#include "scene/media/gaussian_sum.h"
#include "tests/methods/compensated_ray_marching/slab.h"
#include "tests/oracle_vectors.h"

namespace discrete_ordinates_test {

using namespace airlight;
using namespace airlight::test;

namespace {

const std::string file = "compensated_ray_marching";

Slab slab_of(const json& in) {
  Slab slab;
  slab.albedo = number(in.at("albedo"));
  slab.g = number(in.at("g"));
  slab.inflow_top = number(in.at("inflow_top"));
  slab.inflow_bottom = number(in.at("inflow_bottom"));
  return slab;
}

// Relative L2 of the mean media radiance over the vector's places.
double error_of(const Slab& slab, const json& places, const json& mean_radiance) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double z = number(places[i]), expected = number(mean_radiance[i]) - slab.reduced_moment(0, z);
    error += std::pow(slab.mean_media_radiance(z) - expected, 2);
    size += expected * expected;
  }
  return std::sqrt(error / size);
}

// Relative L2 of radiances in single directions.
double radiance_error(const Slab& slab, const json& where, const json& radiance) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < where.size(); ++i) {
    const double expected = number(radiance[i]);
    error += std::pow(slab.radiance(number(where[i][0]), number(where[i][1])) - expected, 2);
    size += expected * expected;
  }
  return std::sqrt(error / size);
}

const json& of_order_4(const json& v) {
  const json& expected = v.at("expected");
  return expected.contains("order4_phase") ? expected.at("order4_phase") : expected;
}

crm::DiscreteOrdinates uniform(const crm::OrdinateGrid& grid, double extinction, double albedo, double g,
                               const crm::OrdinateOptions& options = {}) {
  return {grid, Eigen::ArrayXd::Constant(grid.nodes(), extinction), albedo, {1, g, g * g, g * g * g}, options};
}

// Something without any symmetry.
Eigen::ArrayXd uneven(const crm::OrdinateGrid& grid) {
  Eigen::ArrayXd values(grid.nodes());
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = 0.1 + double((i * 7919) % 101) / 50;
  return values;
}

}  // namespace

TEST_CASE("ordinates: products of harmonics of order 4 are integrated exactly", "[compensated_ray_marching]") {
  for (const auto& directions : {crm::ordinate_directions(4, 8, true), crm::ordinate_directions(4, 8, false)}) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(16, 16);
    for (const crm::Ordinate& d : directions) {
      const std::vector<double> y = scene::evaluate_sh(4, d.direction);
      const Eigen::Map<const Eigen::VectorXd> values(y.data(), 16);
      gram += d.weight * values * values.transpose();
    }
    CHECK((gram - Eigen::MatrixXd::Identity(16, 16)).cwiseAbs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("discrete ordinates: light that is everywhere the same stays so", "[compensated_ray_marching]") {
  const crm::OrdinateGrid grid{{7, 5, 9}, Vec3(0.1, 0.2, 0.15)};
  for (const double albedo : {0.0, 0.6, 1.0}) {
    crm::OrdinateOptions options;
    options.tolerance = 1e-13;
    const crm::DiscreteOrdinates solver = uniform(grid, 3, albedo, 0.4, options);
    crm::Moments source = crm::Moments::Zero(grid.nodes(), 16);
    source.col(0) = 0.7 * (1 - albedo) * std::sqrt(4 * pi);
    const crm::OrdinateSolution s = solver.solve(source, 0.7);
    CHECK((s.radiance.col(0) / std::sqrt(4 * pi) - 0.7).abs().maxCoeff() < 1e-11);
    CHECK(s.radiance.rightCols(15).abs().maxCoeff() < 1e-11);
  }
}

TEST_CASE("discrete ordinates: slabs", "[compensated_ray_marching]") {
  for (const json& v : vectors_of(file, "sn_slab")) {
    const json &in = v.at("input"), &expected = of_order_4(v);
    Slab slab = slab_of(in);
    slab.thickness = number(in.at("optical_thickness"));
    slab.emission = number(in.at("emission_J0"));
    CAPTURE(v.at("id").get<std::string>());
    const json once = v.at("expected").value("single_scattering_moments", json::array());
    CHECK(once.empty() == (slab.inflow_top == 0));
    for (std::size_t i = 0; i < once.size(); ++i)
      for (int l = 0; l < 4; ++l)
        CHECK(slab.albedo * std::pow(slab.g, l) * slab.reduced_moment(l, number(in.at("tau")[i])) ==
              Approx(number(once[i][std::size_t(l)])).margin(1e-9));
    slab.solve(32, 4);
    const double coarse = error_of(slab, in.at("tau"), expected.at("mean_radiance"));
    slab.solve(64, 8);
    const double fine = error_of(slab, in.at("tau"), expected.at("mean_radiance"));
    CAPTURE(coarse, fine);
    CHECK(fine <= (slab.thickness <= 5 ? 0.002 : 0.01));
    CHECK(fine < 0.5 * coarse);
    CHECK(radiance_error(slab, in.at("radiance_tau_mu"), expected.at("radiance")) <=
          (slab.thickness <= 5 ? 0.002 : 0.01));
  }
}

TEST_CASE("discrete ordinates: a slab in layers", "[compensated_ray_marching]") {
  for (const json& v : vectors_of(file, "multiple_scattering_slab_hetero")) {
    const json &in = v.at("input"), &expected = of_order_4(v);
    Slab slab = slab_of(in);
    const double sigma_t = number(in.at("sigma_t")), top = number(in.at("density_top")),
                 height = number(in.at("height")), slope = (number(in.at("density_bottom")) - top) / height;
    slab.thickness = height;
    slab.extinction = [=](double z) { return sigma_t * (top + slope * z); };
    slab.depth = [=](double z) { return sigma_t * (top * z + 0.5 * slope * z * z); };
    slab.solve(32, 4);
    const double coarse = error_of(slab, in.at("z"), expected.at("mean_radiance"));
    slab.solve(128, 8);
    const double fine = error_of(slab, in.at("z"), expected.at("mean_radiance"));
    CAPTURE(v.at("id").get<std::string>(), coarse, fine);
    CHECK(fine <= 0.002);
    CHECK(fine < 0.5 * coarse);
    CHECK(radiance_error(slab, in.at("radiance_z_mu"), expected.at("radiance")) <= 0.002);
  }
}

namespace {

// A ball of smoke under an even sky, on nodes of which one is its centre.
struct Ball {
  double r, sigma_t, albedo, g;
  scene::GaussianSum smoke;
  crm::OrdinateGrid grid;
  int cells;  // a radius

  Ball(const json& in, int cells_a_radius) : cells(cells_a_radius) {
    const json& rbf = in.at("rbf_x_y_z_r_w").at(0);
    r = number(rbf[3]);
    sigma_t = number(in.at("sigma_t"));
    albedo = number(in.at("albedo"));
    g = number(in.at("g"));
    smoke = {{{Point3::Zero(), r, number(rbf[4])}}, 0, number(in.at("cut"))};
    const int n = 6 * cells + 1;
    grid = {{n, n, n}, Vec3::Constant(r / cells)};
  }
  Eigen::Vector3i offset(Eigen::Index i) const {
    const int n = grid.size[0];
    return Eigen::Vector3i(int(i) % n - n / 2, int(i) / n % n - n / 2, int(i) / (n * n) - n / 2);
  }
  // l-th moment of the sky's light at a distance from the centre, about the radius.
  std::array<double, 4> reduced(double distance) const {
    static const scene::GaussLegendre rule = scene::gauss_legendre(48);
    std::array<double, 4> moments{};
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double mu = rule.node[k];
      const Ray back{Point3(0, 0, distance), -Vec3(std::sqrt(1 - mu * mu), 0, mu)};
      const double light = std::exp(-sigma_t * density_integral(smoke, back, {0, infinity}));
      for (int l = 0; l < 4; ++l) moments[std::size_t(l)] += 2 * pi * rule.weight[k] * light * legendre(l, mu);
    }
    return moments;
  }
  // Mean media radiance at those distances from the centre, in radii.
  std::vector<double> solve(const json& distances) const {
    Eigen::ArrayXd extinction(grid.nodes());
    crm::Moments source(grid.nodes(), 16);
    std::map<int, std::array<double, 4>> by_distance;
    for (Eigen::Index i = 0; i < grid.nodes(); ++i) {
      const Point3 x = offset(i).cast<double>() * grid.cell[0];
      extinction[i] = sigma_t * density(smoke, x);
      const auto [found, is_new] = by_distance.try_emplace(offset(i).squaredNorm());
      if (is_new) found->second = reduced(x.norm());
      const std::vector<double> y = scene::evaluate_sh(4, x.norm() > 0 ? Vec3(x.normalized()) : Vec3(0, 0, 1));
      for (int l = 0; l < 4; ++l)
        for (int m = -l; m <= l; ++m)
          source(i, scene::sh_index(l, m)) =
              albedo * std::pow(g, l) * found->second[std::size_t(l)] * y[std::size_t(scene::sh_index(l, m))];
    }
    crm::OrdinateOptions options;
    options.tolerance = 1e-4;
    const crm::OrdinateSolution s =
        crm::DiscreteOrdinates(grid, extinction, albedo, {1, g, g * g, g * g * g}, options).solve(source);
    CHECK(s.error <= 1e-4);
    std::vector<double> means;
    for (const json& distance : distances) {
      double sum = 0;
      for (int axis = 0; axis < 3; ++axis) {
        Eigen::Vector3i at = Eigen::Vector3i::Constant(grid.size[0] / 2);
        at[axis] += int(std::lround(number(distance) * cells));
        sum += s.radiance(at[0] + grid.size[0] * (at[1] + Eigen::Index(grid.size[0]) * at[2]), 0);
      }
      means.push_back(sum / 3 / std::sqrt(4 * pi));
    }
    return means;
  }
};

}  // namespace

TEST_CASE("discrete ordinates: a ball of smoke under an even sky", "[compensated_ray_marching][slow][thorough]") {
  for (const json& v : vectors_of(file, "multiple_scattering_sphere")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    std::vector<double> errors;
    for (const int cells : {4, 12}) {
      const Ball ball(in, cells);
      const std::vector<double> means = ball.solve(in.at("radius_over_r"));
      double error = 0, size = 0;
      for (std::size_t k = 0; k < means.size(); ++k) {
        const double reduced = number(expected.at("mean_reduced_radiance")[k]),
                     media = number(expected.at("mean_radiance")[k]) - reduced;
        CHECK(ball.reduced(number(in.at("radius_over_r")[k]) * ball.r)[0] / (4 * pi) == Approx(reduced).epsilon(1e-6));
        error += std::pow(means[k] - media, 2);
        size += media * media;
      }
      errors.push_back(std::sqrt(error / size));
    }
    // The smoke is 8 or 22 deep. Coarse cells are up to 1.1 or 3.2 deep, fine cells .38 or 1.05.
    // Convergence is of first order here: 8 cells have errors of 0.0066 and 0.016, 12 cells with four
    // times the directions still 0.0044 and 0.0092.
    CAPTURE(v.at("id").get<std::string>(), errors[0], errors[1]);
    CHECK(errors[1] < (number(in.at("albedo")) < 0.95 ? 0.005 : 0.01));
    CHECK(errors[1] < 0.3 * errors[0]);
  }
}

TEST_CASE("discrete ordinates: nothing depends on which way the axes point", "[compensated_ray_marching]") {
  const crm::OrdinateGrid grid{{6, 4, 5}, Vec3(0.3, 0.25, 0.4)};
  const Eigen::ArrayXd extinction = uneven(grid);
  crm::Moments source = crm::Moments::Zero(grid.nodes(), 16);
  source.col(0) = extinction.square();
  const std::vector<double> phase{1, 0.5, 0.25, 0.125};
  const crm::Moments radiance = crm::DiscreteOrdinates(grid, extinction, 0.9, phase, {}).solve(source).radiance;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::ArrayXi mirrored(grid.nodes());
    for (int i = 0; i < int(grid.nodes()); ++i) {
      std::array<int, 3> at{i % 6, i / 6 % 4, i / 24};
      at[std::size_t(axis)] = grid.size[std::size_t(axis)] - 1 - at[std::size_t(axis)];
      mirrored[i] = at[0] + 6 * (at[1] + 4 * at[2]);
    }
    Eigen::ArrayXd there(grid.nodes());
    crm::Moments sent = source;
    for (Eigen::Index i = 0; i < grid.nodes(); ++i) {
      there[mirrored[i]] = extinction[i];
      sent(mirrored[i], 0) = source(i, 0);
    }
    const crm::Moments other = crm::DiscreteOrdinates(grid, there, 0.9, phase, {}).solve(sent).radiance;
    double worst = 0;
    for (Eigen::Index i = 0; i < grid.nodes(); ++i)
      worst = std::max(worst, std::abs(other(mirrored[i], 0) - radiance(i, 0)));
    CHECK(worst < 1e-12 * radiance.col(0).maxCoeff());
  }
}

TEST_CASE("discrete ordinates: a wall takes what meets it", "[compensated_ray_marching]") {
  // Smoke that scatters everything, lit below a wall along every axis in turn; nothing gets behind it, nothing comes back from there.
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    crm::OrdinateGrid grid;
    grid.size = {6, 7, 8};
    grid.cell = Vec3::Constant(0.25);
    const auto place = [&](Eigen::Index node) {
      const Eigen::Index along[3] = {node % 6, node / 6 % 7, node / 42};
      return grid.cell[axis] * (double(along[axis]) + 0.5);
    };
    const double wall = 3.1 * grid.cell[axis];
    int asked = 0;
    const auto objects = [&](Eigen::Index node, const Vec3& back) {
      const double here = place(node);
      return (here < wall) != (here + back[axis] < wall);
    };
    const Eigen::ArrayXd extinction = uneven(grid);
    crm::Moments source = crm::Moments::Zero(grid.nodes(), 16);
    for (Eigen::Index i = 0; i < grid.nodes(); ++i) {
      if (place(i) < wall - grid.cell[axis])
        source(i, 0) = 1 + double(i % 5);  // not beside it: sources between two nodes are not cut
      asked += objects(i, Vec3(0.3, 0.3, 0.3));
    }
    REQUIRE(asked > 0);
    const crm::OrdinateOptions options;
    const auto ways =
        crm::open_ways(grid, crm::ordinate_directions(options.levels, options.azimuths, options.hemispheres), objects);
    const crm::DiscreteOrdinates walled(grid, extinction, 0, {1, 0.3, 0.09, 0.027}, options, ways);
    const auto lit = walled.solve(source);
    const auto open = crm::DiscreteOrdinates(grid, extinction, 0, {1, 0.3, 0.09, 0.027}, {}).solve(source);
    double behind = 0, behind_open = 0, before = 0;
    for (Eigen::Index i = 0; i < grid.nodes(); ++i) {
      if (place(i) > wall + grid.cell[axis]) {
        behind = std::max(behind, std::abs(lit.radiance(i, 0)));
        behind_open = std::max(behind_open, std::abs(open.radiance(i, 0)));
      } else if (place(i) < wall - grid.cell[axis]) {
        before = std::max(before, std::abs(lit.radiance(i, 0) - open.radiance(i, 0)));
      }
    }
    // Rays that run along the wall are interpolated across it, within a cell: 0.04 to 0.06 of what the open grid has there.
    CHECK(behind < 0.06 * behind_open);
    CHECK(behind_open > 0.01);
    CHECK(before == 0);
    const auto scattered =
        crm::DiscreteOrdinates(grid, extinction, 0.9, {1, 0.3, 0.09, 0.027}, options, ways).solve(source);
    double least = 1e9;
    for (Eigen::Index i = 0; i < grid.nodes(); ++i)
      if (place(i) < wall) least = std::min(least, scattered.radiance(i, 0) - lit.radiance(i, 0));
    CHECK(least > 0);
  }
}

// Without albedo each direction has a closed form, and of a source that is linear in the depth the solver's parabolas are exact: thin cells
// (a series) and thick ones (differences of exponentials) alike.
TEST_CASE("discrete ordinates: thin smoke in light that grows along a line", "[compensated_ray_marching]") {
  const int n = 24;
  const crm::OrdinateGrid grid{{1, 1, n}, {1, 1, 1.0 / n}, {true, true, false}};
  const crm::OrdinateOptions options;
  const auto directions = crm::ordinate_directions(options.levels, options.azimuths, options.hemispheres);
  for (const double extinction : {0.01, 0.1, 2.0}) {
    crm::Moments source = crm::Moments::Zero(n, 16);
    for (int i = 0; i < n; ++i) source(i, 0) = std::sqrt(4 * pi) * (0.3 + (i + 0.5) / n);
    const crm::Moments radiance = uniform(grid, extinction, 0, 0, options).sweep(source, 0);
    for (int i = 1; i + 1 < n; ++i) {  // but for the last node of a direction, which sees no source behind it
      double expected = 0;
      for (const crm::Ordinate& d : directions) {
        // From the face where nothing comes in: source b + s x along the way there, x = 0 at the face.
        const double mu = std::abs(d.direction[2]), z = (i + 0.5) / n, slope = d.direction[2] > 0 ? 1 : -1;
        const double way = slope > 0 ? z : 1 - z, at_face = slope > 0 ? 0.3 : 1.3, lag = slope * mu / extinction;
        const double light = at_face + slope * way - lag - (at_face - lag) * std::exp(-extinction * way / mu);
        expected += d.weight * light / std::sqrt(4 * pi);
      }
      CAPTURE(extinction, i);
      CHECK(radiance(i, 0) == Approx(expected).epsilon(1e-8));
    }
  }
}

TEST_CASE("discrete ordinates: the error that is reported bounds that of slow convergence",
          "[compensated_ray_marching]") {
  const crm::OrdinateGrid grid{{8, 8, 8}, Vec3::Constant(0.1)};
  crm::Moments source = crm::Moments::Zero(grid.nodes(), 16);
  source.col(0).setConstant(1);
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    crm::OrdinateOptions options;
    options.tolerance = 1e-10;
    const crm::OrdinateSolution exact = uniform(grid, 20, 1, 0, options).solve(source);
    options.tolerance = tolerance;
    const crm::OrdinateSolution s = uniform(grid, 20, 1, 0, options).solve(source);
    const double off = (s.source.col(0) - exact.source.col(0)).matrix().norm() / exact.source.col(0).matrix().norm();
    CAPTURE(tolerance, s.iterations, s.error, off);
    CHECK(off <= s.error);
  }
}

TEST_CASE("discrete ordinates: extremes", "[compensated_ray_marching]") {
  const crm::OrdinateGrid grid{{8, 8, 8}, Vec3::Constant(0.1)};
  crm::Moments source = crm::Moments::Zero(grid.nodes(), 16);
  SECTION("nothing that scatters") {
    const crm::OrdinateSolution s = uniform(grid, 0, 0.9, 0).solve(source, 2);
    CHECK(s.iterations <= 2);
    CHECK((s.radiance.col(0) / std::sqrt(4 * pi) - 2).abs().maxCoeff() < 1e-12);
  }
  SECTION("albedo 1, thin to very thick: no more than comes in") {
    for (const double extinction : {1e-6, 1.0, 50.0, 1e4}) {
      const crm::OrdinateSolution s = uniform(grid, extinction, 1, 0.5).solve(source, 1);
      CHECK(s.radiance.allFinite());
      CHECK(s.radiance.col(0).maxCoeff() <= (1 + 1e-3) * std::sqrt(4 * pi));
      CHECK(s.radiance.col(0).minCoeff() >= 0);
    }
  }
  SECTION("albedo 1 without inflow, from a source: tens of iterations where plain ones take hundreds") {
    source.col(0).setConstant(1);
    const crm::OrdinateSolution s = uniform(grid, 20, 1, 0).solve(source);
    CHECK(s.error <= 2e-4);
    CHECK(s.iterations < 60);
  }
  SECTION("no albedo") {
    source.col(0).setConstant(1);
    const crm::DiscreteOrdinates solver = uniform(grid, 5, 0, 0);
    const crm::OrdinateSolution s = solver.solve(source);
    CHECK((s.radiance - solver.sweep(source, 0)).abs().maxCoeff() == 0);
    CHECK((s.source - source).abs().maxCoeff() == 0);
  }
  SECTION("a start that is the solution") {
    source.col(0).setConstant(1);
    const crm::DiscreteOrdinates solver = uniform(grid, 10, 0.9, 0.3);
    const crm::OrdinateSolution cold = solver.solve(source), warm = solver.solve(source, 0, &cold.source);
    CHECK(warm.iterations < cold.iterations);
    CHECK((warm.radiance.col(0) - cold.radiance.col(0)).matrix().norm() < 1e-3 * cold.radiance.col(0).matrix().norm());
  }
  SECTION("one node") {
    const crm::OrdinateGrid one{{1, 1, 1}, Vec3::Ones()};
    CHECK(uniform(one, 1, 0.9, 0).solve(crm::Moments::Ones(1, 16)).radiance.allFinite());
  }
}

TEST_CASE("discrete ordinates: the same bits with one thread and two", "[compensated_ray_marching]") {
  const crm::OrdinateGrid grid{{9, 7, 8}, Vec3::Constant(0.2)};
  const crm::DiscreteOrdinates solver(grid, uneven(grid), 0.95, {1, 0.5, 0.25, 0.125}, {});
  crm::Moments source = crm::Moments::Zero(grid.nodes(), 48);
  for (const int light : {0, 16, 32}) source.col(light) = uneven(grid) * (1 + light);
  const crm::OrdinateSolution many = solver.solve(source);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  CHECK((solver.solve(source).radiance - many.radiance).abs().maxCoeff() == 0);
}

TEST_CASE("discrete ordinates: what does not fit is refused", "[compensated_ray_marching]") {
  const crm::OrdinateGrid grid{{2, 2, 2}, Vec3::Ones()};
  CHECK_THROWS_AS(uniform(grid, -1, 0.5, 0), Error);
  CHECK_THROWS_AS(uniform(grid, std::nan(""), 0.5, 0), Error);
  CHECK_THROWS_AS(uniform(grid, 1, 1.5, 0), Error);
  CHECK_THROWS_AS(uniform({{2, 2, 2}, Vec3::Zero()}, 1, 0.5, 0), Error);
  CHECK_THROWS_AS(uniform({{1, 1, 1}, Vec3::Ones(), {true, true, true}}, 1, 0.5, 0), Error);
  CHECK_THROWS_AS(uniform(grid, 1, 0.5, 0).solve(crm::Moments::Zero(8, 15)), Error);
  CHECK_THROWS_AS(uniform(grid, 1, 0.5, 0).solve(crm::Moments::Constant(8, 16, infinity)), Error);
}

}  // namespace discrete_ordinates_test
