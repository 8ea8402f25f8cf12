// Columns of a grid's density along many parallel rays.
#pragma once
#include <vector>

#include "scene/media/region.h"
#include "scene/media/voxel_grid.h"

namespace airlight::compensated_ray_marching {

class GridColumns {
 public:
  // Voxels are numbered by 32 bits.
  static bool knows(const scene::VoxelGrid&);
  // Copies the samples, two layers of voxels wider on each side. The grid outlives this.
  explicit GridColumns(const scene::VoxelGrid&);

  // Integrals of the density from each point along a direction (unit) to where the region ends [m], as density_integral: two-point Gauss in
  // every voxel crossed. Single precision: off by less than 5e-7 of the grid's longest side times its greatest density.
  void from(const std::vector<Point3>& points, const Vec3& direction, const scene::Region&, float* columns) const;

 private:
  // Layers of voxels around the grid. Rounding can let a ray end one voxel outside; a voxel reads samples on both of its sides.
  static constexpr int pad = 2;
  const scene::VoxelGrid& grid_;
  int row_, slice_;
  std::vector<float> values_;
};

}  // namespace airlight::compensated_ray_marching
