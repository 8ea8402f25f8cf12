// One voxel of a grid: eight samples, trilinear between them.
#pragma once
#include <algorithm>

#include "scene/media/voxel_grid.h"

namespace airlight::scene {

// The samples as a function of the position within the voxel. a + f (b - a) returns a constant exactly, and never
// leaves [a, b] by more than rounding.
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

// The voxel between samples 0 and 1 of each axis at `p`, where all eight exist.
inline Voxel inner_voxel(const float* p, std::ptrdiff_t row, std::ptrdiff_t slice) {
  return {{p[0], p[1], p[row], p[row + 1], p[slice], p[slice + 1], p[slice + row], p[slice + row + 1]}};
}

// The voxel whose least corner is sample (i, j, k), each in [-1, n - 1]; beyond the border zero, or the nearest sample.
inline Voxel border_voxel(const VoxelGrid& grid, int i, int j, int k) {
  Voxel v;
  const Eigen::Vector3i last = grid.size.array() - 1;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3i at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
    const Eigen::Vector3i near = at.cwiseMax(0).cwiseMin(last);
    v.corner[c] = grid.clamp_border || near == at ? grid.at(near[0], near[1], near[2]) : 0.0f;
  }
  return v;
}

// How far the support reaches beyond the outermost samples, in voxels.
inline double border_width(const VoxelGrid& grid) { return grid.clamp_border ? 0.5 : 1.0; }

}  // namespace airlight::scene
