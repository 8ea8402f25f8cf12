#include "scene/media/voxel_grid.h"

#include <algorithm>
#include <cmath>

#include "scene/media/region.h"
#include "scene/media/voxel.h"

namespace airlight::scene {
namespace {

// At a position within the support.
double density_within(const VoxelGrid& grid, const Point3& s) {
  const double x = std::floor(s[0]), y = std::floor(s[1]), z = std::floor(s[2]);
  const int i = int(x), j = int(y), k = int(z);
  const std::ptrdiff_t row = grid.size[0], slice = row * grid.size[1];
  const bool inner = i >= 0 && j >= 0 && k >= 0 && i + 1 < grid.size[0] && j + 1 < grid.size[1] && k + 1 < grid.size[2];
  const Voxel v =
      inner ? inner_voxel(grid.values.data() + i + row * j + slice * k, row, slice) : border_voxel(grid, i, j, k);
  return v.at(s[0] - x, s[1] - y, s[2] - z);
}

// Bound of the rounding error of world_to_sample within a box of the world, in voxels.
double sample_rounding(const VoxelGrid& grid, const Point3& farthest) {
  const double reach = farthest.cwiseAbs().sum() + grid.translation.cwiseAbs().sum();
  return 4e-15 *
         (reach / grid.voxel_size + grid.origin_index.cast<double>().cwiseAbs().sum() + grid.size.cast<double>().sum());
}

}  // namespace

Point3 world_to_sample(const VoxelGrid& grid, const Point3& world) {
  return grid.rotation.transpose() * (world - grid.translation) / grid.voxel_size - grid.origin_index.cast<double>();
}

Point3 sample_to_world(const VoxelGrid& grid, const Point3& sample) {
  return grid.rotation * (grid.voxel_size * (sample + grid.origin_index.cast<double>())) + grid.translation;
}

Ray ray_in_samples(const VoxelGrid& grid, const Ray& ray) {
  return {world_to_sample(grid, ray.origin), grid.rotation.transpose() * ray.direction / grid.voxel_size};
}

Box sample_support(const VoxelGrid& grid) {
  if (grid.values.empty()) return {};
  const double width = border_width(grid);
  return {Point3::Constant(-width), grid.size.cast<double>().array() + (width - 1)};
}

double density(const VoxelGrid& grid, const Point3& x) { return density_at_sample(grid, world_to_sample(grid, x)); }

double density_at_sample(const VoxelGrid& grid, const Point3& s) {
  const double width = border_width(grid);
  for (int axis = 0; axis < 3; ++axis)
    if (!(s[axis] >= -width && s[axis] <= grid.size[axis] - 1 + width)) return 0;
  if (grid.values.empty()) return 0;
  return density_within(grid, s);
}

Interval density_bounds(const VoxelGrid& grid, const Box& box) {
  if (grid.values.empty() || box.empty()) return {0, 0};
  // The box seen from the samples, widened by rounding.
  Point3 lo = Point3::Constant(infinity);
  Point3 hi = Point3::Constant(-infinity);
  const Box world = support(grid);
  const Box part = intersect(box, world);
  if (part.empty()) return {0, 0};
  for (int corner = 0; corner < 8; ++corner) {
    const Point3 x(corner & 1 ? part.hi[0] : part.lo[0], corner & 2 ? part.hi[1] : part.lo[1],
                   corner & 4 ? part.hi[2] : part.lo[2]);
    const Point3 s = world_to_sample(grid, x);
    lo = lo.cwiseMin(s);
    hi = hi.cwiseMax(s);
  }
  const double slack = sample_rounding(grid, world.lo.cwiseAbs().cwiseMax(world.hi.cwiseAbs()));
  lo.array() -= slack;
  hi.array() += slack;
  Interval bounds = density_bounds_at_samples(grid, {lo, hi});
  if (!(part.lo == box.lo && part.hi == box.hi)) bounds.lo = 0;
  return bounds;
}

Interval density_bounds_at_samples(const VoxelGrid& grid, const Box& box) {
  const Box inside = intersect(box, sample_support(grid));
  if (inside.empty()) return {0, 0};
  const bool reaches_out = inside.lo != box.lo || inside.hi != box.hi;
  const Box all = sample_support(grid);
  if (inside.lo == all.lo && inside.hi == all.hi) {
    // The whole grid, which is often asked for: its samples, and the zeros around them.
    const Eigen::Map<const Eigen::ArrayXf> values(grid.values.data(), Eigen::Index(grid.values.size()));
    const double least = grid.clamp_border && !reaches_out ? double(values.minCoeff()) : 0;
    return {least * (1 - 4e-15), double(values.maxCoeff()) * (1 + 4e-15)};
  }

  // A trilinear function takes its extremes over a box at the corners; over several voxels at the grid of the box's
  // faces and the samples between them.
  std::vector<double> places[3];
  for (int axis = 0; axis < 3; ++axis) {
    places[axis].push_back(inside.lo[axis]);
    for (int s = int(std::floor(inside.lo[axis])) + 1; s < inside.hi[axis]; ++s) places[axis].push_back(s);
    places[axis].push_back(inside.hi[axis]);
  }
  Interval bounds;
  for (double z : places[2])
    for (double y : places[1])
      for (double x : places[0]) {
        const double value = density_within(grid, {x, y, z});
        bounds = {std::min(bounds.lo, value), std::max(bounds.hi, value)};
      }
  // Four roundings per interpolation, three in a row.
  bounds.lo *= 1 - 4e-15;
  bounds.hi *= 1 + 4e-15;
  if (reaches_out) bounds.lo = 0;
  return bounds;
}

Interval extent(const VoxelGrid& grid, const Ray& ray, Interval t) {
  if (grid.values.empty()) return {};
  return clip(sample_support(grid), ray_in_samples(grid, ray), t);
}

Box support(const VoxelGrid& grid) {
  const Box samples = sample_support(grid);
  Box box;
  if (samples.empty()) return box;
  for (int corner = 0; corner < 8; ++corner) {
    const Point3 s(corner & 1 ? samples.hi[0] : samples.lo[0], corner & 2 ? samples.hi[1] : samples.lo[1],
                   corner & 4 ? samples.hi[2] : samples.lo[2]);
    const Point3 x = sample_to_world(grid, s);
    box = unite(box, {x, x});
  }
  const double slack = grid.voxel_size * sample_rounding(grid, box.lo.cwiseAbs().cwiseMax(box.hi.cwiseAbs()));
  box.lo.array() -= slack;
  box.hi.array() += slack;
  return box;
}

}  // namespace airlight::scene
