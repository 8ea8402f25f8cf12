// Columns of many rays through a grid in single precision against the integral of each in double.
#include "methods/compensated_ray_marching/grid_columns.h"

#include <hwy/targets.h>

#include <catch2/catch.hpp>
#include <limits>
#include <random>

namespace grid_columns_test {

using namespace airlight;
using namespace airlight::compensated_ray_marching;

namespace {

struct Case {
  scene::VoxelGrid grid;
  std::vector<Point3> points;
  Vec3 direction;

  // A grid of random size, place and rotation, half of it empty; points in it, on its samples and around it.
  Case(unsigned seed, double voxel, const Vec3& middle, bool clamped) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    const auto vector = [&] { return Vec3(place(random), place(random), place(random)); };
    for (int axis = 0; axis < 3; ++axis) grid.size[axis] = 1 + int(random() % 23);
    grid.origin_index = Eigen::Vector3i(3, -7, 2);
    grid.voxel_size = voxel;
    grid.translation = middle;
    grid.clamp_border = clamped;
    if (seed % 3 > 0) grid.rotation = Eigen::AngleAxisd(3 * place(random), vector().normalized()).toRotationMatrix();
    if (seed % 3 > 1) grid.rotation.col(1) *= -1;
    for (int i = 0; i < grid.size.prod(); ++i) grid.values.push_back(float(std::max(0.0, place(random))));
    direction = vector();
    if (seed % 4 == 0) direction[int(seed / 4 % 3)] = 0;
    if (seed % 8 == 0) direction[int((seed / 4 + 1) % 3)] = 0;
    direction.normalize();
    if (seed % 5 == 0) direction = (grid.rotation * direction).eval();
    const Vec3 size = grid.size.cast<double>();
    for (int i = 0; i < 37; ++i) {
      Vec3 sample = 0.5 * (size.array() - 1).matrix() + 0.6 * size.cwiseProduct(vector());
      if (i % 4 == 0) sample = sample.array().round();
      points.push_back(sample_to_world(grid, sample));
    }
  }
};

}  // namespace

TEST_CASE("columns of a grid: as the integral of each ray", "[compensated_ray_marching]") {
  unsigned seed = 0;
  double seen = 0;
  for (const auto& [voxel, middle] : {std::pair(1.0, Vec3(0, 0, 0)), std::pair(1e-12, Vec3(0, 0, 0)),
                                      std::pair(0.05, Vec3(1e5, -3e4, 2e5)), std::pair(1e12, Vec3(5, 0, 0))})
    for (int repeat = 0; repeat < 120; ++repeat) {
      const Case c(seed++, voxel, middle, repeat % 2 == 0);
      const Vec3 size = c.grid.size.cast<double>();
      const Point3 heart = sample_to_world(c.grid, 0.5 * size);
      const std::vector<scene::Region> regions = {scene::Unbounded{},
                                                  scene::Sphere{heart, 0.4 * voxel * size.maxCoeff()},
                                                  scene::Slab{Vec3::UnitY(), heart[1] - voxel, heart[1] + 2 * voxel}};
      const scene::Region& region = regions[std::size_t(repeat % 3)];
      std::vector<float> columns(c.points.size(), -1);
      GridColumns(c.grid).from(c.points, c.direction, region, columns.data());
      for (std::size_t i = 0; i < c.points.size(); ++i) {
        const Ray ray{c.points[i], c.direction};
        const double exact = density_integral(c.grid, ray, scene::clip(region, ray, {0, infinity}));
        CAPTURE(seed, i, exact, columns[i], c.grid.size.transpose(), c.direction.transpose());
        // Single precision: places and lengths are rounded in each voxel, in either direction; 1.7e-7 of the side is the worst
        // seen. Far from the origin the points themselves are coarser: ten roundings of their coordinates.
        const double single = 4 * double(std::numeric_limits<float>::epsilon());
        const double rounding = single + 1e-15 * middle.norm() / voxel * 10;
        REQUIRE(std::abs(columns[i] - exact) <= rounding * voxel * size.maxCoeff());
        seen = std::max(seen, exact / voxel);
      }
    }
  CHECK(seen > 5);
}

TEST_CASE("columns of a grid: the same bits whatever the instruction set and the number of points",
          "[compensated_ray_marching]") {
  const Case c(7, 0.1, Vec3(1, 2, 3), false);
  const GridColumns columns(c.grid);
  std::vector<float> wide(c.points.size()), narrow = wide;
  columns.from(c.points, c.direction, scene::Unbounded{}, wide.data());
  hwy::SetSupportedTargetsForTest(HWY_AVX2);
  hwy::GetChosenTarget().DeInit();
  columns.from(c.points, c.direction, scene::Unbounded{}, narrow.data());
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  CHECK(wide == narrow);
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    float alone = -1;
    columns.from({c.points[i]}, c.direction, scene::Unbounded{}, &alone);
    CHECK(alone == wide[i]);
  }
}

}  // namespace grid_columns_test
