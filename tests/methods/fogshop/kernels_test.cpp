#include "methods/fogshop/kernels.h"

#include <catch2/catch.hpp>
#include <random>

#include "methods/fogshop/paper_airlight.h"
#include "tests/methods/fogshop/vectors.h"

namespace kernels_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::relative_error;

TEST_CASE("vector error functions", "[fogshop]") {
  const auto worst = [](Erf erf) {
    double error = 0;
    for (int i = -80000; i <= 80000; ++i)
      error = std::max(error, std::abs(error_function(erf, i * 1e-4) - std::erf(i * 1e-4)));
    return error;
  };
  CHECK(worst(Erf::precise) <= 1.3e-12);
  CHECK(worst(Erf::erf10) <= 3.9e-6);
  // The paper claims 2e-4; its polynomial jumps to 1 at the cut and misses the claim by 1.1e-7.
  CHECK(worst(Erf::paper) <= 2.0012e-4);
  CHECK(worst(Erf::paper) >= 2.0e-4);
  for (Erf erf : {Erf::precise, Erf::erf10, Erf::paper}) {
    CHECK(error_function(erf, 0) == 0);
    CHECK(error_function(erf, infinity) == 1);
    CHECK(error_function(erf, -infinity) == -1);
    CHECK(error_function(erf, -0.7) == -error_function(erf, 0.7));
  }
}

namespace {

struct Random {
  std::mt19937 engine;
  double uniform(double lo, double hi) { return lo + (hi - lo) * (engine() / 4294967296.0); }
  Point3 point(double lo, double hi) { return {uniform(lo, hi), uniform(lo, hi), uniform(lo, hi)}; }
};

std::vector<scene::Gaussian> cloud(Random& random, int n) {
  std::vector<scene::Gaussian> gaussians;
  for (int i = 0; i < n; ++i)
    gaussians.push_back({random.point(-3, 3), random.uniform(0.1, 1.5), random.uniform(0.05, 3)});
  return gaussians;
}

}  // namespace

// Depths by vectors against the scene's line integrals. A culled Gaussian loses at most its threshold, the error
// function 1.2e-12 of each Gaussian's depth, both ends: with n = 50 and depths below 10 that is 1.2e-9.
TEST_CASE("depths along lines", "[fogshop]") {
  Random random{std::mt19937(3)};
  for (int trial = 0; trial < 200; ++trial) {
    const auto gaussians = cloud(random, 50);
    const GaussianArrays arrays = make_arrays(gaussians, Cull::depth, 1e-14).arrays;
    const Point3 from = random.point(-4, 4), to = random.point(-4, 4);
    const Line line = line_between(from, to);
    Crossings crossings;
    cross(arrays, line, Erf::precise, crossings);
    double exact = 0, to_infinity = 0;
    for (const auto& g : gaussians) {
      exact += optical_depth(g, from, to);
      to_infinity += line_integral(g, {from, line.direction}, infinity);
    }
    CHECK(std::abs(total_depth(crossings, line.length, Erf::precise) - exact) <= 1.2e-9);
    const double t[8] = {0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1};
    double ends[8], depths[8];
    for (int k = 0; k < 8; ++k) ends[k] = t[k] * line.length;
    depths_at(crossings, ends, 8, depths, Erf::precise);
    for (int k = 0; k < 8; ++k)
      CHECK(std::abs(depths[k] - optical_depth(scene::GaussianSum{gaussians, 0, infinity}, from,
                                               from + ends[k] * line.direction)) <= 1.2e-9);
    cross(arrays, {from, line.direction, infinity}, Erf::precise, crossings);
    CHECK(std::abs(total_depth(crossings, infinity, Erf::precise) - to_infinity) <= 1.2e-9);
  }
}

// The loss by culling stays below n thresholds, at every scale of the scene.
TEST_CASE("culling by depth loses what it says", "[fogshop]") {
  Random random{std::mt19937(4)};
  for (double scale : {0.01, 1.0, 100.0}) {
    auto gaussians = cloud(random, 100);
    for (auto& g : gaussians) g = {g.center * scale, g.width * scale, g.amplitude / scale};
    const GaussianArrays arrays = make_arrays(gaussians, Cull::depth, 1e-4).arrays;
    double worst = 0;
    for (int trial = 0; trial < 500; ++trial) {
      const Line line = line_between(random.point(-4, 4) * scale, random.point(-4, 4) * scale);
      Crossings crossings;
      cross(arrays, line, Erf::precise, crossings);
      double exact = 0;
      for (const auto& g : gaussians) exact += line_integral(g, {line.origin, line.direction}, line.length);
      const double lost = exact - total_depth(crossings, line.length, Erf::precise);
      CHECK(lost >= -1e-9);
      worst = std::max(worst, lost);
    }
    CHECK(worst <= 100 * 1e-4);
    CHECK(worst > 0);  // something was culled
  }
}

// A medium of depth 1e-8 keeps its Gaussians.
TEST_CASE("culling by depth is relative in thin media", "[fogshop]") {
  const CulledGaussians thin = make_arrays({{Point3(0, 0, 4), 1, 5e-9}}, Cull::depth, 1e-4);
  CHECK(thin.arrays.count == 1);
  CHECK(std::sqrt(thin.arrays.radius_squared[0]) == Approx(std::sqrt(std::log(1e4))).epsilon(1e-12));
  const CulledGaussians mixed = make_arrays({{Point3(0, 0, 4), 1, 5e-9}, {Point3(0, 0, 4), 1, 2}}, Cull::depth, 1e-4);
  CHECK(mixed.arrays.count == 1);
  CHECK(mixed.dropped == 1);
}

TEST_CASE("the paper's cull depends on the scale", "[fogshop]") {
  // R = sqrt(ln c + 9)/a: a hundred times larger and thinner, the same Gaussian is cut nearer in widths.
  CHECK(cull_radius(1, 1, Cull::paper, 0) == Approx(3).epsilon(1e-15));
  CHECK(cull_radius(0.01, 0.01, Cull::paper, 0) == Approx(100 * std::sqrt(9 + std::log(0.01))).epsilon(1e-15));
  CHECK(cull_radius(1, 1e-5, Cull::paper, 0) == 0);  // negative root in the paper
  CHECK(cull_radius(0.01, 0.01, Cull::depth, 1e-4) ==
        Approx(100 * cull_radius(1, 1, Cull::depth, 1e-4)).epsilon(1e-14));
}

// Depths from a point to the edges of a ray, over the Gaussians that come near the triangle.
TEST_CASE("depths from a light to a ray", "[fogshop]") {
  Random random{std::mt19937(5)};
  for (int trial = 0; trial < 200; ++trial) {
    const auto gaussians = cloud(random, 60);
    const GaussianArrays arrays = make_arrays(gaussians, Cull::depth, 1e-14).arrays;
    const Point3 light = random.point(-4, 4);
    const Line ray = line_between(random.point(-4, 4), random.point(-4, 4));
    const double lo = 0.2 * ray.length, hi = 0.8 * ray.length;
    std::vector<int> places;
    near_triangle(arrays, light, ray, lo, hi, places);
    double t[16], depth[16];
    for (int k = 0; k < 16; ++k) t[k] = lo + (hi - lo) * k / 15;
    depths_from_point(subset(arrays, places), light, ray, t, 16, depth, Erf::precise);
    for (int k = 0; k < 16; ++k)
      CHECK(std::abs(depth[k] - optical_depth(scene::GaussianSum{gaussians, 0, infinity}, light,
                                              ray.origin + t[k] * ray.direction)) <= 1.5e-9);
  }
}

TEST_CASE("Gaussians far from the triangle are left out", "[fogshop]") {
  const GaussianArrays arrays =
      make_arrays({{Point3(0, 0, 5), 0.1, 1}, {Point3(0, 30, 5), 0.1, 1}, {Point3(0, 0, 40), 0.1, 1}}, Cull::depth,
                  1e-4)
          .arrays;
  std::vector<int> places;
  near_triangle(arrays, Point3(4, 0, 5), {Point3(0, 0, 0), Vec3(0, 0, 1), 10}, 0, 10, places);
  CHECK(places == std::vector<int>{0});
}

}  // namespace kernels_test
