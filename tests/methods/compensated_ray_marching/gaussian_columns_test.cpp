// Columns of many rays in single precision against the integral of each in double.
#include "methods/compensated_ray_marching/gaussian_columns.h"

#include <hwy/targets.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace gaussian_columns_test {

using namespace airlight;
using namespace airlight::compensated_ray_marching;

namespace {

struct Case {
  scene::GaussianSum sum;
  std::vector<Point3> points;
  Vec3 direction;
  double scale = 0;  // of the error: what all have on lines through their centres, amplitude times width

  Case(unsigned seed, double cutoff, std::size_t count, const Vec3& middle, double size) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1, 1), share(0, 1);
    const auto vector = [&] { return Vec3(place(random), place(random), place(random)); };
    sum.cutoff = cutoff;
    for (int i = 0; i < 300; ++i) {
      const double width = 0.02 * std::pow(30.0, share(random));
      sum.gaussians.push_back({middle + size * vector(), size * width, share(random)});
      scale += sum.gaussians.back().amplitude * sum.gaussians.back().width;
    }
    const Vec3 corner = middle + size * vector();
    for (std::size_t i = 0; i < count; ++i) points.push_back(corner + 0.2 * size * vector());
    direction = vector().normalized();
  }
  std::vector<float> columns() const {
    std::vector<float> columns(points.size(), -1);
    GaussianColumns(sum).from(points, direction, columns.data());
    return columns;
  }
};

}  // namespace

// The error of a Gaussian is 1.5e-7 of its integral in erf, twice, and some rounding; those of 300 are not all of one sign.
TEST_CASE("columns of Gaussians: as the integral of each ray", "[compensated_ray_marching]") {
  unsigned seed = 1;
  for (const double cutoff : {0.5, 3.0, 4.5, 5.0, infinity})
    for (const std::size_t count : {std::size_t(1), std::size_t(5), std::size_t(16), std::size_t(37), std::size_t(64)})
      for (const auto& [middle, size] : {std::pair(Vec3(0, 0, 0), 1.0), std::pair(Vec3(1e6, -3e5, 2e6), 1.0),
                                         std::pair(Vec3(0, 0, 0), 1e-6), std::pair(Vec3(5, 0, 0), 1e6)}) {
        const Case c(seed++, cutoff, count, middle, size);
        const std::vector<float> columns = c.columns();
        double worst = 0, greatest = 0;
        for (std::size_t i = 0; i < count; ++i) {
          const double exact = density_integral(c.sum, {c.points[i], c.direction}, {0, infinity});
          worst = std::max(worst, std::abs(columns[i] - exact));
          greatest = std::max(greatest, exact);
        }
        INFO("cutoff " << cutoff << ", " << count << " points, size " << size << ", seed " << seed - 1);
        if (cutoff >= 3) CHECK(greatest > 1e-3 * c.scale);  // one ray may pass between short Gaussians
        CHECK(worst < 3e-7 * c.scale);
      }
}

TEST_CASE("columns of Gaussians: the same bits whatever the instruction set", "[compensated_ray_marching]") {
  for (const double cutoff : {3.0, infinity}) {
    const Case c(7, cutoff, 61, Vec3(1, 2, 3), 2);
    const std::vector<float> wide = c.columns();
    hwy::SetSupportedTargetsForTest(HWY_AVX2);
    hwy::GetChosenTarget().DeInit();
    const std::vector<float> narrow = c.columns();
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
    CHECK(wide == narrow);
  }
}

TEST_CASE("columns of Gaussians: sums that are clamped or have no end are not known", "[compensated_ray_marching]") {
  scene::GaussianSum sum{{{Point3::Zero(), 1, 1}}, 0, infinity};
  CHECK(GaussianColumns::knows(sum));
  sum.constant = 0.1;
  CHECK(!GaussianColumns::knows(sum));
  sum.constant = 0;
  sum.gaussians.push_back({Point3::Ones(), 1, -0.1});
  CHECK(!GaussianColumns::knows(sum));
}

}  // namespace gaussian_columns_test
