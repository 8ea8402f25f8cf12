// Smoke for tests of fits, and the bounds that a fit keeps.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/convert/gaussian_fit.h"

namespace airlight::test {

using scene::FitOptions;
using scene::Gaussian;
using scene::GaussianFit;
using scene::VoxelGrid;

inline VoxelGrid empty_grid(int nx, int ny, int nz) {
  VoxelGrid grid;
  grid.size = {nx, ny, nz};
  grid.voxel_size = 0.05;
  grid.origin_index = {3, -2, 1};
  grid.translation = {0.7, 0, -0.3};
  grid.values.assign(std::size_t(nx) * ny * nz, 0.0f);
  return grid;
}

// Folded smoke: where two waves are both high, moving with time.
inline VoxelGrid smoke(int n, double time = 0) {
  VoxelGrid grid = empty_grid(n, n, n);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double x = (i + 0.5) / n, y = (j + 0.5) / n, z = (k + 0.5) / n - 0.1 * time;
        const double waves = std::sin(9 * x + 4 * std::sin(5 * z)) * std::sin(8 * y + 3 * std::sin(6 * x)) + 0.2;
        const double column = std::exp(-20 * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5)));
        grid.values[std::size_t(i + n * (j + n * k))] = float(std::max(0.0, 2 * column * waves - 0.1));
      }
  return grid;
}

inline FitOptions options(int gaussians) {
  FitOptions o;
  o.gaussians = gaussians;
  return o;
}

inline void check_bounds(const VoxelGrid& grid, const GaussianFit& fit) {
  const double unit = scene::fit_unit(grid), greatest = *std::max_element(grid.values.begin(), grid.values.end());
  const double lo = std::max(0.015 * unit, scene::least_fit_width * grid.voxel_size),
               hi = std::max(0.09 * unit, 2 * lo);
  for (const Gaussian& g : fit.sum.gaussians) {
    const Point3 s = scene::world_to_sample(grid, g.center);
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(s[axis] >= -0.5 - 1e-9);
      CHECK(s[axis] <= grid.size[axis] - 0.5 + 1e-9);
    }
    CHECK(g.width >= lo * (1 - 1e-12));
    CHECK(g.width <= hi * (1 + 1e-12));
    CHECK(g.amplitude >= 0.01 * greatest * (1 - 1e-12));
    CHECK(g.amplitude <= greatest * (1 + 1e-12));
  }
}

}  // namespace airlight::test
