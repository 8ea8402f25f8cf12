// Gaussians at the samples of a grid, against the medium's own density.
#include "scene/convert/gaussian_samples.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace gaussian_samples_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

VoxelGrid turned_grid() {
  VoxelGrid grid;
  grid.size = {19, 12, 23};
  grid.origin_index = {-4, 7, 2};
  grid.rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  grid.voxel_size = 0.13;
  grid.translation = {0.4, -0.2, 3};
  return grid;
}

double directly(const GaussianSum& sum, const Point3& x) {
  double value = sum.constant;
  for (const Gaussian& g : sum.gaussians) {
    const double e = (x - g.center).squaredNorm() / (g.width * g.width);
    if (e < sum.cutoff * sum.cutoff) value += g.amplitude * std::exp(-e);
  }
  return value;
}

GaussianSum several(const VoxelGrid& grid, double cutoff) {
  GaussianSum sum;
  sum.cutoff = cutoff;
  for (int i = 0; i < 40; ++i) {
    const Point3 at(std::fmod(7.3137 * i, 25.0) - 3, std::fmod(3.7071 * i, 16.0) - 2, std::fmod(5.9393 * i, 29.0) - 3);
    sum.gaussians.push_back(
        {sample_to_world(grid, at), grid.voxel_size * (0.3 + 0.11 * i), i % 3 == 0 ? -0.4 : 0.2 + 0.05 * i});
  }
  return sum;
}

}  // namespace

TEST_CASE("Gaussians at samples are the medium's density, not clamped", "[gaussian_samples][convert]") {
  const VoxelGrid grid = turned_grid();
  for (const double cutoff : {0.8, 3.0, infinity}) {
    GaussianSum sum = several(grid, cutoff);
    if (cutoff == 3) sum.constant = 0.25;
    const std::vector<float> values = gaussian_samples(sum, grid, 1);
    REQUIRE(values.size() == std::size_t(19) * 12 * 23);
    bool negative = false;
    std::size_t at = 0;
    for (int k = 0; k < grid.size[2]; ++k)
      for (int j = 0; j < grid.size[1]; ++j)
        for (int i = 0; i < grid.size[0]; ++i, ++at) {
          CAPTURE(cutoff, i, j, k);
          const Point3 x = sample_to_world(grid, Point3(i, j, k));
          REQUIRE(values[at] == Approx(directly(sum, x)).margin(5e-6));
          REQUIRE(std::max(0.0f, values[at]) == Approx(density(sum, x)).margin(5e-6));
          negative |= values[at] < 0;
        }
    CHECK(negative);
    CHECK(values == gaussian_samples(sum, grid, 2));
  }
}

TEST_CASE("a sample on the cutoff's sphere is outside, as in the medium", "[gaussian_samples][convert]") {
  VoxelGrid grid;
  grid.size = {16, 16, 16};
  GaussianSum sum{{{Point3(8, 8, 8), 2, 1}}, 0, 1.5};
  const std::vector<float> values = gaussian_samples(sum, grid);
  const auto at = [&](int i, int j, int k) { return values[std::size_t(i + 16 * (j + 16 * k))]; };
  for (const auto [i, j, k] : {std::array{11, 8, 8}, {5, 8, 8}, {8, 11, 8}, {8, 8, 5}, {6, 10, 9}})
    CHECK(at(i, j, k) == 0);
  CHECK(at(10, 9, 8) == Approx(std::exp(-1.25)));
  CHECK(at(10, 10, 8) == Approx(std::exp(-2.0)));
  // The other way round: 2.25 in place of the least cutoff beyond it.
  sum.cutoff = std::nextafter(1.5, 2);
  CHECK(gaussian_samples(sum, grid)[11 + 16 * (8 + 16 * 8)] == Approx(std::exp(-2.25)));
}

TEST_CASE("Gaussians outside, of no amplitude or narrower than a sample", "[gaussian_samples][convert]") {
  VoxelGrid grid;
  grid.size = {5, 1, 3};
  grid.voxel_size = 0.5;
  GaussianSum sum;
  sum.cutoff = 3;
  for (const double far : {1e3, -1e3, 1e12, -1e300}) sum.gaussians.push_back({Point3(far, 0, 0), 1, 1});
  sum.gaussians.push_back({Point3(1, 0, 0.5), 1, 0});
  sum.gaussians.push_back({Point3(1.1, 0, 0.5), 1e-9, 1});
  for (const float value : gaussian_samples(sum, grid)) CHECK(value == 0);
  sum.gaussians.push_back({Point3(1, 0, 0.5), 1e-9, 2});
  CHECK(gaussian_samples(sum, grid)[2 + 5 * 1] == 2);
  sum.constant = 0.5;
  CHECK(gaussian_samples(sum, grid)[0] == 0.5);
  CHECK(gaussian_samples(sum, VoxelGrid()).empty());
}

}  // namespace gaussian_samples_test
