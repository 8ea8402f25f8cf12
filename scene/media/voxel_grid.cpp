#include "scene/media/voxel_grid.h"

#include <algorithm>
#include <cmath>

#include "scene/media/region.h"

namespace airlight::scene {
namespace {

// The eight samples around a voxel, as a trilinear function of the position within it. a + f (b - a) returns a constant
// exactly, and never leaves [a, b] by more than rounding.
struct Voxel {
  double corner[8];  // x fastest

  double at(double fx, double fy, double fz) const {
    const double c00 = corner[0] + fx * (corner[1] - corner[0]);
    const double c10 = corner[2] + fx * (corner[3] - corner[2]);
    const double c01 = corner[4] + fx * (corner[5] - corner[4]);
    const double c11 = corner[6] + fx * (corner[7] - corner[6]);
    const double c0 = c00 + fy * (c10 - c00);
    const double c1 = c01 + fy * (c11 - c01);
    return c0 + fz * (c1 - c0);
  }
};

// The voxel whose least corner is sample (i, j, k), each in [-1, n - 1]; beyond the border zero, or the nearest sample.
Voxel voxel(const VoxelGrid& grid, int i, int j, int k) {
  Voxel v;
  const int nx = grid.size[0], ny = grid.size[1], nz = grid.size[2];
  const std::ptrdiff_t row = nx;
  const std::ptrdiff_t slice = row * ny;
  if (i >= 0 && j >= 0 && k >= 0 && i + 1 < nx && j + 1 < ny && k + 1 < nz) {
    const float* p = grid.values.data() + i + row * j + slice * k;
    v.corner[0] = p[0];
    v.corner[1] = p[1];
    v.corner[2] = p[row];
    v.corner[3] = p[row + 1];
    v.corner[4] = p[slice];
    v.corner[5] = p[slice + 1];
    v.corner[6] = p[slice + row];
    v.corner[7] = p[slice + row + 1];
    return v;
  }
  for (int c = 0; c < 8; ++c) {
    int x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
    if (grid.clamp_border) {
      x = std::clamp(x, 0, nx - 1);
      y = std::clamp(y, 0, ny - 1);
      z = std::clamp(z, 0, nz - 1);
    }
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz;
    v.corner[c] = inside ? grid.at(x, y, z) : 0.0f;
  }
  return v;
}

// How far the support reaches beyond the outermost samples, in voxels.
double margin(const VoxelGrid& grid) { return grid.clamp_border ? 0.5 : 1.0; }

Box sample_support(const VoxelGrid& grid) {
  if (grid.values.empty()) return {};
  return {Point3::Constant(-margin(grid)), grid.size.cast<double>() + Point3::Constant(margin(grid) - 1)};
}

double density_at_sample(const VoxelGrid& grid, const Point3& s) {
  const Point3 cell(std::floor(s[0]), std::floor(s[1]), std::floor(s[2]));
  // The upper end of the support with a border rule is no integer: no cell starts there.
  return voxel(grid, int(cell[0]), int(cell[1]), int(cell[2])).at(s[0] - cell[0], s[1] - cell[1], s[2] - cell[2]);
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

double density(const VoxelGrid& grid, const Point3& x) {
  const Point3 s = world_to_sample(grid, x);
  const double below = -margin(grid);
  for (int axis = 0; axis < 3; ++axis)
    if (!(s[axis] >= below && s[axis] <= grid.size[axis] - 1 - below)) return 0;
  if (grid.values.empty()) return 0;
  return density_at_sample(grid, s);
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

  const Box inside = intersect(Box{lo, hi}, sample_support(grid));
  if (inside.empty()) return {0, 0};
  const bool reaches_out = !(part.lo == box.lo && part.hi == box.hi) || inside.lo != lo || inside.hi != hi;

  // A trilinear function takes its extremes over a box at the corners; over several voxels at the grid of the box's
  // faces and the samples between them.
  std::vector<double> places[3];
  for (int axis = 0; axis < 3; ++axis) {
    places[axis].push_back(inside.lo[axis]);
    for (double s = std::floor(inside.lo[axis]) + 1; s < inside.hi[axis]; ++s) places[axis].push_back(s);
    places[axis].push_back(inside.hi[axis]);
  }
  Interval bounds;
  for (double z : places[2])
    for (double y : places[1])
      for (double x : places[0]) {
        const double value = density_at_sample(grid, {x, y, z});
        bounds = {std::min(bounds.lo, value), std::max(bounds.hi, value)};
      }
  // Four roundings per interpolation, three in a row.
  bounds.lo *= 1 - 4e-15;
  bounds.hi *= 1 + 4e-15;
  if (reaches_out) bounds.lo = 0;
  return bounds;
}

double density_integral(const VoxelGrid& grid, const Ray& ray, Interval t) {
  if (grid.values.empty() || t.empty()) return 0;
  // In samples: s = origin + t * direction, t still in metres.
  const Point3 origin = world_to_sample(grid, ray.origin);
  const Vec3 direction = grid.rotation.transpose() * ray.direction / grid.voxel_size;
  t = clip(sample_support(grid), Ray{origin, direction}, t);
  if (t.empty()) return 0;

  // Walk from face to face. Each face's t is computed from its index, not by adding steps: nothing drifts.
  int cell[3], step[3];
  double face[3];  // t at which the ray leaves the cell along this axis
  const Point3 start = origin + t.lo * direction;
  for (int axis = 0; axis < 3; ++axis) {
    step[axis] = direction[axis] > 0 ? 1 : -1;
    cell[axis] = std::clamp(int(std::floor(start[axis])), -1, grid.size[axis] - 1);
    const auto leave = [&] { return (cell[axis] + (step[axis] > 0) - origin[axis]) / direction[axis]; };
    face[axis] = direction[axis] == 0 ? infinity : leave();
    // A start on a face belongs to the cell that the ray enters.
    while (face[axis] <= t.lo && cell[axis] + step[axis] >= -1 && cell[axis] + step[axis] < grid.size[axis]) {
      cell[axis] += step[axis];
      face[axis] = leave();
    }
  }

  constexpr double gauss = 0.21132486540518712;  // (1 - 1/sqrt(3)) / 2
  double integral = 0;
  double enter = t.lo;
  while (true) {
    const int axis = face[0] < face[1] ? (face[0] < face[2] ? 0 : 2) : (face[1] < face[2] ? 1 : 2);
    const double leave = std::min(face[axis], t.hi);
    const double length = leave - enter;
    if (length > 0) {
      const Voxel v = voxel(grid, cell[0], cell[1], cell[2]);
      const auto value = [&](double at) {
        return v.at(origin[0] + at * direction[0] - cell[0], origin[1] + at * direction[1] - cell[1],
                    origin[2] + at * direction[2] - cell[2]);
      };
      integral += 0.5 * length * (value(enter + gauss * length) + value(leave - gauss * length));
      enter = leave;
    }
    if (!(face[axis] < t.hi)) return integral;
    cell[axis] += step[axis];
    if (cell[axis] < -1 || cell[axis] >= grid.size[axis]) return integral;
    face[axis] = (cell[axis] + (step[axis] > 0) - origin[axis]) / direction[axis];
  }
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
