#include "scene/media/voxel_grid.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/scene/media/random_points.h"

namespace voxel_grid_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

VoxelGrid random_grid(RandomPoints& random, Eigen::Vector3i size, bool clamp_border, bool place) {
  VoxelGrid grid;
  grid.size = size;
  grid.clamp_border = clamp_border;
  for (int i = 0; i < size.prod(); ++i) grid.values.push_back(float(std::max(0.0, random.uniform(-0.5, 1))));
  if (place) {
    grid.origin_index = {-3, 7, 2};
    grid.voxel_size = 0.37;
    grid.translation = {1.5, -2, 0.25};
    grid.rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  }
  return grid;
}

// The definition, sample by sample: sum of value times the product of hat functions; with the border rule the position
// is moved to the nearest one among the samples, within half a voxel.
double naive_density(const VoxelGrid& grid, Point3 s) {
  if (grid.clamp_border) {
    for (int axis = 0; axis < 3; ++axis) {
      if (s[axis] < -0.5 || s[axis] > grid.size[axis] - 0.5) return 0;
      s[axis] = std::clamp(s[axis], 0.0, grid.size[axis] - 1.0);
    }
  }
  double sum = 0;
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const double weight = std::max(0.0, 1 - std::abs(s[0] - i)) * std::max(0.0, 1 - std::abs(s[1] - j)) *
                              std::max(0.0, 1 - std::abs(s[2] - k));
        sum += weight * grid.at(i, j, k);
      }
  return sum;
}

Box around(const VoxelGrid& grid) {
  Box box = support(grid);
  const Vec3 more = 0.2 * box.size();
  return {box.lo - more, box.hi + more};
}

// By Gauss quadrature between all crossings with integer planes, found by sorting: exact in every piece (degree 3), and
// with nothing in common with the walk through voxels.
double naive_integral(const VoxelGrid& grid, const Ray& ray, Interval t) {
  const Point3 origin = world_to_sample(grid, ray.origin);
  const Vec3 direction = (world_to_sample(grid, ray.at(1)) - origin);
  std::vector<double> cuts{t.lo, t.hi};
  for (int axis = 0; axis < 3; ++axis)
    for (double plane = -1; plane <= grid.size[axis]; plane += 0.5) {
      const double at = (plane - origin[axis]) / direction[axis];
      if (at > t.lo && at < t.hi) cuts.push_back(at);
    }
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double middle = 0.5 * (cuts[i] + cuts[i + 1]), half = 0.5 * (cuts[i + 1] - cuts[i]);
    const double node = std::sqrt(0.6) * half;
    const auto at = [&](double s) { return naive_density(grid, origin + s * direction); };
    sum += half * (5 * at(middle - node) + 8 * at(middle) + 5 * at(middle + node)) / 9;
  }
  return sum;
}

const std::vector<Eigen::Vector3i> sizes = {{5, 4, 6}, {1, 1, 1}, {1, 5, 2}, {8, 1, 1}};

}  // namespace

TEST_CASE("a voxel grid maps samples to the world and back", "[media]") {
  RandomPoints random(1);
  const VoxelGrid grid = random_grid(random, {5, 4, 6}, false, true);
  for (int i = 0; i < 100; ++i) {
    const Point3 s = random.in({Point3::Constant(-9), Point3::Constant(9)});
    CHECK(world_to_sample(grid, sample_to_world(grid, s)).isApprox(s, 1e-14));
  }
  // Sample 0 lies at the grid's index (-3, 7, 2).
  CHECK(sample_to_world(grid, Point3::Zero())
            .isApprox(grid.rotation * Vec3(-3 * 0.37, 7 * 0.37, 2 * 0.37) + grid.translation, 1e-14));
}

TEST_CASE("density of a grid is its definition, at and between samples", "[media]") {
  RandomPoints random(2);
  for (bool clamp : {false, true})
    for (bool place : {false, true})
      for (const auto& size : sizes) {
        const VoxelGrid grid = random_grid(random, size, clamp, place);
        for (int i = 0; i < 2000; ++i) {
          const Point3 x = random.in(around(grid));
          const Point3 s = world_to_sample(grid, x);
          CHECK(density(grid, x) == Approx(naive_density(grid, s)).margin(1e-14));
        }
        if (place) continue;
        for (int k = 0; k < size[2]; ++k)
          for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i) CHECK(density(grid, Point3(i, j, k)) == double(grid.at(i, j, k)));
      }
}

TEST_CASE("line integrals of a grid against quadrature", "[media]") {
  RandomPoints random(3);
  for (bool clamp : {false, true})
    for (bool place : {false, true})
      for (const auto& size : sizes) {
        const VoxelGrid grid = random_grid(random, size, clamp, place);
        const Box box = around(grid);
        for (int i = 0; i < 200; ++i) {
          // Rays from inside and outside; every third parallel to an axis of the world.
          Ray ray{random.in(box), random.direction()};
          if (i % 3 == 0) ray.direction = (i % 2 ? 1 : -1) * Vec3::Unit(i / 6 % 3);
          const Interval t{random.uniform(-1, 1), random.uniform(1, 12)};
          INFO(clamp << place << " size " << size.transpose() << " ray " << i);
          CHECK(density_integral(grid, ray, t) == Approx(naive_integral(grid, ray, t)).epsilon(1e-12).margin(1e-13));
        }
      }
}

// A ray within a plane of samples: the integral is that of the bilinear field of the plane, whichever side the walk
// takes. Stress 15: the same as one ulp beside it. Along an edge of voxels: the trapezium rule over its samples.
TEST_CASE("stress 15: rays within voxel faces and along voxel edges", "[media]") {
  RandomPoints random(4);
  const VoxelGrid grid = random_grid(random, {5, 4, 6}, false, false);
  for (int plane = 0; plane < 5; ++plane) {
    const Vec3 direction = Vec3(0, 0.6, 0.8);
    const Ray ray{Point3(plane, -1.3, -2), direction};
    const double got = density_integral(grid, ray, {0, infinity});
    CHECK(got == Approx(naive_integral(grid, ray, {0, 20})).epsilon(1e-13));
    for (double side : {-infinity, infinity}) {
      Ray beside = ray;
      beside.origin[0] = std::nextafter(ray.origin[0], side);
      CHECK(density_integral(grid, beside, {0, infinity}) == Approx(got).epsilon(1e-14));
    }
  }
  for (int j = 0; j < 4; ++j)
    for (int k = 0; k < 6; ++k) {
      double samples = 0;
      for (int i = 0; i < 5; ++i) samples += grid.at(i, j, k);
      for (double sign : {1.0, -1.0}) {
        const Ray along{Point3(-sign * 10, j, k), sign * Vec3::UnitX()};
        CHECK(density_integral(grid, along, {0, infinity}) == Approx(samples).epsilon(1e-14));
      }
    }
  // On the outermost face of the support the density is 0.
  CHECK(density_integral(grid, {{-1, 1, -5}, Vec3::UnitZ()}, {0, infinity}) == 0);
  CHECK(density_integral(grid, {{5, 1, -5}, Vec3::UnitZ()}, {0, infinity}) == 0);
  // With the border rule that face still belongs to the closed support.
  VoxelGrid border = grid;
  border.clamp_border = true;
  CHECK(density_integral(border, {{-0.5, 1, -5}, Vec3::UnitZ()}, {0, infinity}) ==
        Approx(naive_integral(border, {{0, 1, -5}, Vec3::UnitZ()}, {0, 20})).epsilon(1e-13));
}

// Segments that end on a voxel face, an edge or a sample: the parts add up, nothing is counted twice or left out.
TEST_CASE("stress 15: a ray that moves too slowly along an axis to reach a face", "[media]") {
  RandomPoints random(11);
  const VoxelGrid grid = random_grid(random, {6, 5, 4}, false, false);
  for (const double slow : {1e-308, -1e-308, 1e-320, 1e-200, -1e-200}) {
    const Ray still{{-2, 2.25, 1.5}, {1, 0, 0}}, moving{{-2, 2.25, 1.5}, {1, slow, -slow}};
    CHECK(density_integral(grid, moving, {0, infinity}) ==
          Approx(density_integral(grid, still, {0, infinity})).epsilon(1e-14));
  }
}

TEST_CASE("stress 13: a light on a voxel face", "[media]") {
  RandomPoints random(5);
  for (bool clamp : {false, true}) {
    const VoxelGrid grid = random_grid(random, {6, 6, 6}, clamp, false);
    for (int i = 0; i < 300; ++i) {
      Point3 light = random.in({Point3::Constant(-1), Point3::Constant(6)});
      for (int axis = 0; axis <= i % 3; ++axis) light[axis] = std::round(light[axis]);
      const Vec3 direction = i % 5 ? random.direction() : Vec3(Vec3::Unit(i % 3));
      const double before = random.uniform(0, 9), after = random.uniform(0, 9);
      const Ray ray{light, direction};
      const double whole = naive_integral(grid, ray, {-before, after});
      CHECK(density_integral(grid, ray, {-before, 0}) + density_integral(grid, ray, {0, after}) ==
            Approx(whole).epsilon(1e-12).margin(1e-13));
      CHECK(density_integral(grid, ray, {-before, after}) == Approx(whole).epsilon(1e-12).margin(1e-13));
      // And walked the other way.
      CHECK(density_integral(grid, {light, -direction}, {-after, before}) ==
            Approx(whole).epsilon(1e-12).margin(1e-13));
    }
  }
}

TEST_CASE("the integral of a grid over a segment is the sum over its parts", "[media]") {
  RandomPoints random(6);
  const VoxelGrid grid = random_grid(random, {7, 5, 6}, false, true);
  for (int i = 0; i < 300; ++i) {
    const Ray ray{random.in(around(grid)), random.direction()};
    const double a = random.uniform(0, 2), b = a + random.uniform(0, 1e-6), c = b + random.uniform(0, 3);
    const double parts =
        density_integral(grid, ray, {0, a}) + density_integral(grid, ray, {a, b}) + density_integral(grid, ray, {b, c});
    CHECK(parts == Approx(density_integral(grid, ray, {0, c})).epsilon(1e-13).margin(1e-15));
  }
}

TEST_CASE("bounds of a grid hold under random probing, and are tight", "[media]") {
  RandomPoints random(7);
  for (bool clamp : {false, true})
    for (bool place : {false, true})
      for (const auto& size : sizes) {
        const VoxelGrid grid = random_grid(random, size, clamp, place);
        for (int i = 0; i < 150; ++i) {
          const Box box = random.box(around(grid));
          const Interval bounds = density_bounds(grid, box);
          Interval seen;
          for (int k = 0; k < 200; ++k) {
            Point3 x = random.in(box);
            for (int axis = 0; axis < 3; ++axis) {
              const double u = random.uniform(0, 3);
              if (u < 1) x[axis] = u < 0.5 ? box.lo[axis] : box.hi[axis];
            }
            const double value = density(grid, x);
            seen = {std::min(seen.lo, value), std::max(seen.hi, value)};
          }
          CHECK(seen.lo >= bounds.lo);
          CHECK(seen.hi <= bounds.hi);
          // Without rotation they are the extremes up to rounding, which a box inside one voxel takes at its corners.
          if (!place && box.size().maxCoeff() < 1e-3 && !clamp) {
            CHECK(bounds.hi - seen.hi <= 0.2 * (bounds.hi - bounds.lo) + 1e-12);
            CHECK(seen.lo - bounds.lo <= 0.2 * (bounds.hi - bounds.lo) + 1e-12);
          }
        }
      }
}

// A cell of 4^3 voxels whose faces lie on samples must not see the samples of its neighbours: majorants would double.
TEST_CASE("bounds of a cell end at its faces", "[media]") {
  VoxelGrid grid;
  grid.size = {9, 9, 9};
  grid.values.assign(729, 1.0f);
  for (int j = 0; j < 9; ++j)
    for (int k = 0; k < 9; ++k) grid.values[5 + 9 * (j + 9 * k)] = 100;
  CHECK(density_bounds(grid, {{0, 0, 0}, {4, 4, 4}}).hi == Approx(1).epsilon(1e-10));
  CHECK(density_bounds(grid, {{4, 0, 0}, {8, 4, 4}}).hi == Approx(100));
  CHECK(density_bounds(grid, {{0, 0, 0}, {4, 4, 4}}).lo == Approx(1));
  // Reaching out of the support the least is 0, and beyond it both are.
  CHECK(density_bounds(grid, {{-2, 0, 0}, {4, 4, 4}}).lo == 0);
  CHECK(density_bounds(grid, {{-9, 0, 0}, {-2, 4, 4}}).hi == 0);
  CHECK(density_bounds(grid, {Point3::Constant(-infinity), Point3::Constant(infinity)}).hi == Approx(100));
}

TEST_CASE("a constant grid is a homogeneous medium", "[media]") {
  RandomPoints random(8);
  VoxelGrid grid = random_grid(random, {6, 5, 4}, true, true);
  grid.values.assign(120, 0.7f);
  for (int i = 0; i < 200; ++i) {
    // Within the samples' box every interpolation returns the constant, bit for bit.
    const Point3 x = sample_to_world(grid, random.in({{0, 0, 0}, {5, 4, 3}}));
    CHECK(density(grid, x) == 0.7f);
    const Point3 y = sample_to_world(grid, random.in({{0, 0, 0}, {5, 4, 3}}));
    const double length = (y - x).norm();
    CHECK(density_integral(grid, {x, (y - x) / length}, {0, length}) == Approx(0.7f * length).epsilon(1e-13));
  }
}

TEST_CASE("stress 18: minus zero and subnormal voxels", "[media]") {
  VoxelGrid grid;
  grid.size = {2, 2, 2};
  grid.values.assign(8, -0.0f);
  const Ray ray{{-3, 0.5, 0.5}, Vec3::UnitX()};
  CHECK(density(grid, Point3::Constant(0.5)) == 0);
  CHECK(density_integral(grid, ray, {0, infinity}) == 0);
  CHECK(density_bounds(grid, {Point3::Zero(), Point3::Ones()}).hi == 0);
  grid.values.assign(8, 1e-45f);  // the least subnormal
  CHECK(density(grid, Point3::Constant(0.5)) == double(1e-45f));
  CHECK(density_integral(grid, ray, {0, infinity}) == Approx(2 * double(1e-45f)).epsilon(1e-14));
}

TEST_CASE("stress 19: an empty grid, one voxel, one active voxel", "[media]") {
  const VoxelGrid empty;
  const Ray ray{{-9, 0.25, -0.5}, Vec3::UnitX()};
  CHECK(density(empty, Point3::Zero()) == 0);
  CHECK(density_integral(empty, ray, {0, infinity}) == 0);
  CHECK(density_bounds(empty, {Point3::Constant(-1), Point3::Constant(1)}).hi == 0);
  CHECK(support(empty).empty());
  // One sample is a hat in each axis: along x it integrates to value (1 - |y|) (1 - |z|).
  VoxelGrid one;
  one.size = {1, 1, 1};
  one.values = {3};
  CHECK(density(one, Point3::Zero()) == 3);
  CHECK(density_integral(one, ray, {0, infinity}) == Approx(3 * 0.75 * 0.5).epsilon(1e-14));
  // With the border rule it is a cube.
  one.clamp_border = true;
  CHECK(density(one, {0.5, -0.5, 0.1}) == 3);
  CHECK(density(one, {0.51, -0.5, 0.1}) == 0);
  CHECK(density_integral(one, ray, {0, infinity}) == Approx(3).epsilon(1e-14));
  // The sample inside a block of zeros.
  VoxelGrid active;
  active.size = {3, 3, 3};
  active.origin_index = {-1, -1, -1};
  active.values.assign(27, 0);
  active.values[13] = 3;
  CHECK(density_integral(active, ray, {0, infinity}) == Approx(3 * 0.75 * 0.5).epsilon(1e-14));
}

TEST_CASE("scaling by a power of two is bit-identical: grids", "[media]") {
  RandomPoints random(9);
  for (double scale : {0x1p-10, 0x1p14}) {
    const VoxelGrid grid = random_grid(random, {5, 6, 4}, false, true);
    VoxelGrid scaled = grid;
    scaled.voxel_size *= scale;
    scaled.translation *= scale;
    for (int i = 0; i < 200; ++i) {
      const Ray ray{random.in(around(grid)), random.direction()};
      CHECK(density(scaled, scale * ray.origin) == density(grid, ray.origin));
      CHECK(density_integral(scaled, {scale * ray.origin, ray.direction}, {0, scale * 2}) ==
            scale * density_integral(grid, ray, {0, 2}));
    }
  }
}

// Far from the origin of the world positions are known to 1e-16 of the distance: 1e6 voxels cost six digits.
TEST_CASE("stress 17: a grid far away from the origin", "[media]") {
  RandomPoints random(10);
  const VoxelGrid grid = random_grid(random, {5, 6, 4}, false, false);
  VoxelGrid far = grid;
  const Vec3 shift(1e6, -1e6, 1e6);
  far.translation += shift;
  for (int i = 0; i < 100; ++i) {
    const Ray ray{random.in(around(grid)), random.direction()};
    CHECK(density_integral(far, {ray.origin + shift, ray.direction}, {0, 4}) ==
          Approx(density_integral(grid, ray, {0, 4})).margin(1e-8));
  }
}

}  // namespace voxel_grid_test
