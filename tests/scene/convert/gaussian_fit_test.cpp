// Smoke as Gaussians: objective and gradient, minimisers, bounds, odd grids.
#include "scene/convert/gaussian_fit.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "scene/base/error.h"
#include "scene/convert/fit_gauss_newton.h"
#include "scene/convert/fit_lbfgs.h"
#include "scene/convert/fit_normal_matrix.h"
#include "scene/convert/fit_placement.h"
#include "scene/convert/gaussian_samples.h"
#include "scene/load/csv_table.h"
#include "scene/scene.h"
#include "tests/scene/convert/fitted_grids.h"
#include "tests/temporary_folder.h"

namespace gaussian_fit_test {

using namespace airlight;
using namespace airlight::scene;
using namespace airlight::test;

namespace {

std::vector<Gaussian> some_gaussians(int n, double side) {
  std::vector<Gaussian> gaussians;
  for (int i = 0; i < n; ++i)
    gaussians.push_back({Point3(std::fmod(3.7313 * i, side), std::fmod(5.1117 * i, side), std::fmod(2.3331 * i, side)),
                         1 + 0.07 * i, 0.1 + 0.03 * i});
  return gaussians;
}

double ratio_by_samples(const VoxelGrid& grid, const GaussianFit& fit) {
  const std::vector<float> values = gaussian_samples(fit.sum, grid);
  double off = 0, all = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    off += std::pow(double(values[i]) - grid.values[i], 2);
    all += double(grid.values[i]) * grid.values[i];
  }
  return off / all;
}

bool same(const GaussianFit& a, const GaussianFit& b) {
  if (a.ids != b.ids || a.next_id != b.next_id || a.sum.gaussians.size() != b.sum.gaussians.size()) return false;
  for (std::size_t i = 0; i < a.sum.gaussians.size(); ++i) {
    const Gaussian &x = a.sum.gaussians[i], &y = b.sum.gaussians[i];
    if (x.center != y.center || x.width != y.width || x.amplitude != y.amplitude) return false;
  }
  return a.errors.squared_ratio == b.errors.squared_ratio;
}

}  // namespace

TEST_CASE("a fit's gradient is that of its objective", "[gaussian_fit][convert]") {
  // Far beyond where the cutoff jumps: differences across a jump are no derivative.
  const VoxelGrid grid = smoke(14);
  const std::vector<double> values(grid.values.begin(), grid.values.end());
  FitObjective<double> objective(grid.size, values.data(), 1, 26, 2);
  std::vector<Gaussian> gaussians = some_gaussians(9, 14);
  std::vector<double> gradient(5 * gaussians.size());
  const double value = objective.value(gaussians, gradient.data());
  CHECK(value > 1);
  for (std::size_t i = 0; i < gaussians.size(); ++i)
    for (int v = 0; v < 5; ++v) {
      CAPTURE(i, v);
      const double x = variable(gaussians[i], v), h = 1e-5;
      variable(gaussians[i], v) = x + h;
      const double above = objective.value(gaussians);
      variable(gaussians[i], v) = x - h;
      const double below = objective.value(gaussians);
      variable(gaussians[i], v) = x;
      CHECK(gradient[5 * i + std::size_t(v)] == Approx((above - below) / (2 * h)).epsilon(1e-6).margin(1e-6));
    }
}

TEST_CASE("a fit's objective in single precision, by any number of threads", "[gaussian_fit][convert]") {
  const VoxelGrid grid = smoke(21);
  const std::vector<double> values(grid.values.begin(), grid.values.end());
  FitObjective<double> exact(grid.size, values.data(), 1, 3, 1);
  FitObjective<float> one(grid.size, grid.values.data(), 1, 3, 1), two(grid.size, grid.values.data(), 1, 3, 2);
  const std::vector<Gaussian> gaussians = some_gaussians(30, 21);
  std::vector<double> g0(150), g1(150), g2(150);
  const double v0 = exact.value(gaussians, g0.data());
  CHECK(one.value(gaussians, g1.data()) == Approx(v0).epsilon(1e-6));
  CHECK(two.value(gaussians, g2.data()) == one.value(gaussians));
  CHECK(g1 == g2);
  for (std::size_t i = 0; i < 150; ++i) CHECK(g1[i] == Approx(g0[i]).epsilon(1e-4).margin(1e-4));
  // Gaussians that are added one by one give the value of all at once; correlations predict it.
  double value = one.value({gaussians.begin(), gaussians.end() - 3});
  for (std::size_t i = 27; i < 30; ++i) {
    const auto [with_error, with_itself] = one.correlation(gaussians[i]);
    value += gaussians[i].amplitude * (2 * with_error + gaussians[i].amplitude * with_itself);
    one.add(gaussians[i]);
  }
  CHECK(value == Approx(v0).epsilon(1e-5));
  CHECK(one.errors().squared_ratio == Approx(v0 / exact.sum_of_squares()).epsilon(1e-5));
}

TEST_CASE("products of Gaussians' derivatives are their integrals", "[gaussian_fit][convert]") {
  const Gaussian a{Point3(10.2, 9.7, 10.4), 2.1, 0.7}, b{Point3(11.9, 10.6, 9.1), 1.6, -0.4};
  Matrix5 sums = Matrix5::Zero();
  const auto derivatives = [](const Gaussian& g, const Point3& x) {
    const Vec3 d = x - g.center;
    const double r2 = g.width * g.width, value = std::exp(-d.squaredNorm() / r2);
    Vector5 by;
    by << 2 * g.amplitude / r2 * value * d, 2 * g.amplitude / (r2 * g.width) * value * d.squaredNorm(), value;
    return by;
  };
  for (int k = 0; k < 21; ++k)
    for (int j = 0; j < 21; ++j)
      for (int i = 0; i < 21; ++i)
        sums += derivatives(a, Point3(i, j, k)) * derivatives(b, Point3(i, j, k)).transpose();
  CHECK((overlap_derivatives(a, b) - sums).norm() < 1e-5 * sums.norm());
  CHECK((overlap_derivatives(b, a) - sums.transpose()).norm() < 1e-5 * sums.norm());
}

// Gradients that point out of the bounds are projected: what begins there leads no minimiser outside, and does not stop it.
TEST_CASE("each minimiser lowers the objective and keeps the bounds, also from there", "[gaussian_fit][convert]") {
  const VoxelGrid grid = smoke(20);
  const FitBounds bounds{{Point3::Constant(-0.5), Point3::Constant(19.5)}, {0.7, 1.8}, {0.01, 1}};
  const float greatest = *std::max_element(grid.values.begin(), grid.values.end());
  FitObjective<float> objective(grid.size, grid.values.data(), 1 / greatest, 3, 2);
  std::vector<Gaussian> start = place_gaussians(grid.size, grid.values.data(), 1 / greatest, 40, bounds);
  REQUIRE(start.size() == 40);
  for (const bool from_bounds : {false, true}) {
    for (std::size_t i = 0; from_bounds && i < start.size(); ++i) {
      for (int v = 3; v < 5; ++v) variable(start[i], v) = (i >> (v - 3)) % 2 ? bounds.lo(v) : bounds.hi(v);
      if (i % 5 == 0) start[i].center[int(i / 5) % 3] = i % 2 ? -0.5 : 19.5;
    }
    const double before = objective.value(start);
    std::vector<double> ends;
    for (int method = 0; method < 2; ++method) {
      CAPTURE(from_bounds, method);
      std::vector<Gaussian> gaussians = start;
      const MinimizerOptions how{15, 1e-5, {}};
      const Minimization done = method == 0 ? minimize_gauss_newton(objective, bounds, gaussians, how)
                                            : minimize_lbfgs(objective, bounds, gaussians, how);
      CHECK(done.value < 0.8 * before);
      CHECK(objective.value(gaussians) == Approx(done.value));
      ends.push_back(done.value);
      for (const Gaussian& g : gaussians)
        for (int v = 0; v < 5; ++v) {
          CHECK(variable(g, v) >= bounds.lo(v));
          CHECK(variable(g, v) <= bounds.hi(v));
        }
      if (from_bounds) continue;
      const int moved = teleport(objective, bounds, gaussians, 5);
      CHECK((moved > 0 ? objective.value(gaussians) < done.value : objective.value(gaussians) == Approx(done.value)));
    }
    // Newton's kind is not behind after as many iterations.
    if (!from_bounds) CHECK(ends[0] < 1.1 * ends[1]);
  }
}

TEST_CASE("what a Gaussian gains at its place is what the objective loses", "[gaussian_fit][convert]") {
  const VoxelGrid grid = smoke(20);
  const FitBounds bounds{{Point3::Constant(-0.5), Point3::Constant(19.5)}, {0.7, 1.8}, {0.01, 1}};
  const float greatest = *std::max_element(grid.values.begin(), grid.values.end());
  FitObjective<float> objective(grid.size, grid.values.data(), 1 / greatest, 3, 2);
  std::vector<Gaussian> gaussians = place_gaussians(grid.size, grid.values.data(), 1 / greatest, 20, bounds);
  const double before = objective.value(gaussians);
  const Placed placed = place_at(objective, bounds, missing_places(objective, bounds, 1).at(0));
  REQUIRE(placed.gain > 0);
  gaussians.push_back(placed.gaussian);
  CHECK(before - objective.value(gaussians) == Approx(placed.gain).epsilon(1e-4));
  // Another amplitude of the same Gaussian gains less: the placed one is the best.
  for (const double factor : {0.9, 1.1}) {
    gaussians.back().amplitude = factor * placed.gaussian.amplitude;
    CHECK(before - objective.value(gaussians) < placed.gain);
  }
}

TEST_CASE("more Gaussians fit better, and what is deposited is so", "[gaussian_fit][convert]") {
  const VoxelGrid grid = smoke(32);
  double last = 1;
  for (const int n : {15, 60, 240}) {
    const GaussianFit fit = fit_gaussians(grid, options(n));
    CAPTURE(n);
    CHECK(int(fit.sum.gaussians.size()) == n);
    CHECK(fit.errors.squared_ratio < 0.4 * last);
    last = fit.errors.squared_ratio;
    CHECK(ratio_by_samples(grid, fit) == Approx(last).epsilon(1e-3));
    CHECK(fit.errors.relative_l2 == Approx(std::sqrt(last)));
    CHECK(fit.errors.max >= fit.errors.max_filled);
    CHECK(fit.errors.rms_filled > fit.errors.rms);
    check_bounds(grid, fit);
  }
}

// A ball that ends in a kink: along its surface Gaussians of width h number 1/h^2, and sum E^2 ~ h^3: n^-3/2 at best, n^-0.7 where they all
// begin, and so stay, where the mass is.
TEST_CASE("more Gaussians gather along the edge of smoke", "[gaussian_fit][convert]") {
  VoxelGrid grid = empty_grid(32, 32, 32);
  for (int k = 0; k < 32; ++k)
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i)
        grid.values[std::size_t(i + 32 * (j + 32 * k))] =
            float(std::max(0.0, 1 - (Point3(i, j, k) - Point3::Constant(15.5)).squaredNorm() / 95));
  const GaussianFit few = fit_gaussians(grid, options(50)), many = fit_gaussians(grid, options(400));
  CAPTURE(few.errors.squared_ratio, many.errors.squared_ratio);
  CHECK(many.ids.size() == 400);
  CHECK(many.errors.squared_ratio < few.errors.squared_ratio * std::pow(8, -0.9));
}

TEST_CASE("the same fit by one thread and two, and of turned smoke", "[gaussian_fit][convert]") {
  VoxelGrid grid = smoke(24);
  FitOptions one = options(60), two = one;
  one.threads = 1;
  two.threads = 2;
  const GaussianFit a = fit_gaussians(grid, one), b = fit_gaussians(grid, two);
  CHECK(same(a, b));
  CHECK(same(next_fit(smoke(24, 0.2), a, one), next_fit(smoke(24, 0.2), b, two)));
  grid.rotation = Eigen::AngleAxisd(0.8, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  const GaussianFit turned = fit_gaussians(grid, one);
  CHECK(turned.errors.squared_ratio == a.errors.squared_ratio);
  CHECK(ratio_by_samples(grid, turned) == Approx(a.errors.squared_ratio).epsilon(1e-3));
}

TEST_CASE("one Gaussian is found again", "[gaussian_fit][convert]") {
  VoxelGrid grid = empty_grid(30, 30, 30);
  const GaussianSum truth{{{sample_to_world(grid, Point3(14, 16, 13)), 0.1, 0.8}}, 0, 3};
  grid.values = gaussian_samples(truth, grid);
  const GaussianFit fit = fit_gaussians(grid, options(1));
  REQUIRE(fit.sum.gaussians.size() == 1);
  CHECK((fit.sum.gaussians[0].center - truth.gaussians[0].center).norm() < 1e-3 * 0.1);
  CHECK(fit.sum.gaussians[0].width == Approx(0.1).epsilon(1e-3));
  // No more than the greatest sample, which therefore lies in the centre.
  CHECK(fit.sum.gaussians[0].amplitude ==
        Approx(*std::max_element(grid.values.begin(), grid.values.end())).epsilon(1e-3));
  CHECK(fit.errors.squared_ratio < 1e-3);
}

TEST_CASE("grids at the edge of sense", "[gaussian_fit][convert]") {
  SECTION("no density") {
    const GaussianFit fit = fit_gaussians(empty_grid(6, 5, 4), options(20));
    CHECK(fit.sum.gaussians.empty());
    CHECK(fit.errors.squared_ratio == 0);
    CHECK(fit_gaussians(VoxelGrid(), options(20)).ids.empty());
  }
  SECTION("one voxel, few voxels, flat grids: lengths are the box's, not an axis'") {
    for (const Eigen::Vector3i& size : {Eigen::Vector3i(1, 1, 1), {2, 3, 5}, {1, 24, 24}, {40, 1, 1}}) {
      VoxelGrid grid = empty_grid(size[0], size[1], size[2]);
      for (std::size_t i = 0; i < grid.values.size(); ++i) grid.values[i] = 0.2f + 0.1f * float(i % 3);
      const GaussianFit fit = fit_gaussians(grid, options(8));
      CAPTURE(size[0], size[1], size[2], fit.errors.squared_ratio);
      CHECK(fit.sum.gaussians.size() == std::min<std::size_t>(8, grid.values.size()));
      CHECK(std::isfinite(fit.errors.squared_ratio));
      CHECK(fit.errors.squared_ratio < 0.9);
      CHECK(fit_unit(grid) == Approx(0.05 * std::cbrt(double(size.prod()))));
      check_bounds(grid, fit);
    }
  }
  SECTION("all density in one voxel") {
    VoxelGrid grid = empty_grid(32, 32, 32);
    grid.values[32 * 32 * 16 + 32 * 16 + 16] = 3;
    const GaussianFit fit = fit_gaussians(grid, options(10));
    REQUIRE(fit.sum.gaussians.size() == 1);
    CHECK(fit.sum.gaussians[0].center.allFinite());
    CHECK(fit.errors.squared_ratio < 0.6);
    check_bounds(grid, fit);
  }
  SECTION("density whose middle lies beyond a face, and on one") {
    for (const double beyond : {0.1, 0.0}) {
      VoxelGrid grid = empty_grid(20, 20, 20);
      const Point3 middle = sample_to_world(grid, Point3(19.5, 10, 10)) + Vec3(beyond, 0, 0);
      grid.values = gaussian_samples({{{middle, 0.15, 1}}, 0, 3}, grid);
      const GaussianFit fit = fit_gaussians(grid, options(6));
      CAPTURE(beyond, fit.errors.squared_ratio);
      CHECK(fit.errors.squared_ratio < 0.05);
      check_bounds(grid, fit);
    }
  }
  SECTION("even density everywhere") {
    VoxelGrid grid = empty_grid(20, 20, 20);
    std::fill(grid.values.begin(), grid.values.end(), 0.5f);
    const GaussianFit fit = fit_gaussians(grid, options(400));
    CHECK(fit.errors.squared_ratio < 0.05);
    check_bounds(grid, fit);
  }
  SECTION("densities as small and as great as floats go") {
    for (const float scale : {1e-38f, 1e-30f, 1e30f}) {
      VoxelGrid grid = smoke(16);
      for (float& value : grid.values) value *= scale;
      const GaussianFit fit = fit_gaussians(grid, options(30));
      CHECK(fit.errors.squared_ratio ==
            Approx(fit_gaussians(smoke(16), options(30)).errors.squared_ratio).epsilon(0.2));
    }
  }
}

TEST_CASE("a single filled voxel takes the least width there is", "[gaussian_fit][convert]") {
  VoxelGrid grid = smoke(12);
  std::fill(grid.values.begin(), grid.values.end(), 0.0f);
  grid.values[5 + 12 * (6 + 12 * 7)] = 1;
  // By how much its samples, added up, exceed the integral of a Gaussian at a sample: what the bound is there for.
  for (const auto& [voxels, excess] : {std::pair(least_fit_width, 1.05), {0.5, 1.6}, {0.35, 4.2}, {2.0, 1.0}}) {
    FitOptions o = options(1);
    o.widths.lo = 1e-3;
    o.least_voxels = voxels;
    const GaussianFit fit = fit_gaussians(grid, o);
    REQUIRE(fit.sum.gaussians.size() == 1);
    const double width = fit.sum.gaussians[0].width / grid.voxel_size;
    CHECK(width >= voxels * (1 - 1e-12));
    CHECK(width < voxels * (voxels < 0.5 ? 1.2 : 1.001));  // there samples hardly tell one width from another
    double along = 0;
    for (int i = -9; i <= 9; ++i) along += std::exp(-std::pow(i / voxels, 2));
    CHECK(std::pow(along / (std::sqrt(pi) * voxels), 3) == Approx(excess).epsilon(0.01));
  }
}

TEST_CASE("what is no density is refused with its voxel, and so are absurd numbers", "[gaussian_fit][convert]") {
  VoxelGrid grid = empty_grid(4, 5, 6);
  for (const float bad : {-1e-3f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    grid.values[2 + 4 * (3 + 5 * 1)] = bad;
    CHECK_THROWS_WITH(fit_gaussians(grid, options(5)), Catch::Contains("voxel (2, 3, 1)"));
  }
  CHECK_THROWS_WITH(fit_gaussians(smoke(4), options(1000000)), Catch::Contains("1000000, expected 1 to 65536"));
  CHECK_THROWS_WITH(fit_gaussians(smoke(4), options(0)), Catch::Contains("expected 1 to"));
  FitOptions o = options(5);
  o.unit = -1;
  CHECK_THROWS_AS(fit_gaussians(smoke(4), o), Error);
  o = options(5);
  o.least_voxels = 0;
  CHECK_THROWS_WITH(fit_gaussians(smoke(4), o), Catch::Contains("voxels above 0"));
  CHECK_THROWS_WITH(fit_method_from("lbgfs"), Catch::Contains("lbfgs"));
  for (const auto& [name, method] : fit_methods()) CHECK(fit_method_from(name) == method);
}

TEST_CASE("a fit's table is a medium's table", "[gaussian_fit][convert]") {
  const TemporaryFolder folder;
  const GaussianFit fit = fit_gaussians(smoke(16), options(30));
  write_gaussians_csv(folder.file("fit.csv"), fit);
  const Scene scene = parse_scene(
      "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[medium]]\ntype = 'gaussians'\nfile = 'fit.csv'\ncutoff = 3\n",
      "s.toml", folder.path().string());
  const auto& sum = std::get<GaussianSum>(scene.media.at(0).field);
  REQUIRE(sum.gaussians.size() == fit.sum.gaussians.size());
  for (std::size_t i = 0; i < sum.gaussians.size(); ++i) {
    CHECK(sum.gaussians[i].center == fit.sum.gaussians[i].center);
    CHECK(sum.gaussians[i].width == fit.sum.gaussians[i].width);
    CHECK(sum.gaussians[i].amplitude == fit.sum.gaussians[i].amplitude);
  }
}

TEST_CASE("Gaussians are sent to random filled voxels by turns", "[gaussian_fit][convert]") {
  VoxelGrid grid;
  grid.size = {12, 10, 11};
  for (int i = 0; i < 12 * 10 * 11; ++i)
    grid.values.push_back(i % 12 < 4 ? 0 : float(1 + std::sin(0.37 * i) * std::cos(0.011 * i)));
  const auto places = random_places(grid.size, grid.values.data(), 3, 50);
  REQUIRE(places.size() == 50);
  for (const Point3& p : places) CHECK(p[0] >= 4);
  CHECK(places == random_places(grid.size, grid.values.data(), 3, 50));
  CHECK(places != random_places(grid.size, grid.values.data(), 4, 50));
  FitOptions options;
  options.gaussians = 40;
  options.threads = 1;
  options.teleport = Teleport::none;
  const GaussianFit none = fit_gaussians(grid, options);
  options.teleport = Teleport::alternating;
  const GaussianFit both = fit_gaussians(grid, options);
  CHECK(none.teleported == 0);
  CHECK(both.teleported > 0);
  CHECK(both.errors.squared_ratio < none.errors.squared_ratio);
}

}  // namespace gaussian_fit_test
