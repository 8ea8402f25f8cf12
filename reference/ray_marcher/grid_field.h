// A voxel grid laid out for marching: padded samples, and a map of empty space.
//
// Local coordinates: sample coordinates plus 2, so that every point of the support, rounding included, lies in a cell
// with four corners on each side of it. Padding is zero, or repeats the border with clamp_border.
//
// The map holds for each brick of 4^3 cells how far one may go in any direction (Chebyshev distance, in cells) from any
// point of the brick and still be where the density is zero; -1 where the brick is not empty. Moving by that distance
// or less, in the largest component, lands in zero density.
#pragma once
#include <memory>
#include <vector>

#include "scene/media/voxel_grid.h"

namespace airlight::ray_marcher {

// x local = m * x world + b.
struct Frame {
  double m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  double b[3] = {0, 0, 0};
  Point3 point(const Point3& x) const;
  Vec3 vector(const Vec3& v) const;
};

// Data that does not depend on the grid's position: shared by frames in which it moves.
struct GridSamples {
  // Each sample with its neighbour along z, x fastest: four corners of a cell are then 16 bytes in a row.
  std::vector<float> pairs;
  std::vector<float> free_distance;  // per brick, x fastest
};

struct GridField {
  Frame frame;
  int size[3];  // padded samples per axis
  int bricks[3];
  float lo[3], hi[3];  // the support, local
  std::shared_ptr<const GridSamples> samples;

  static constexpr int padding = 2, brick_shift = 2;
  // Free distance of the brick around a local point inside the padded grid.
  float free_at(double px, double py, double pz) const {
    const int x = int(px) >> brick_shift, y = int(py) >> brick_shift, z = int(pz) >> brick_shift;
    return samples->free_distance[x + std::size_t(bricks[0]) * (y + std::size_t(bricks[1]) * z)];
  }
};

// `before` was made of the grid `from`, another frame's: where the values are the same, the samples are shared.
std::shared_ptr<const GridField> make_grid_field(const scene::VoxelGrid&, const scene::VoxelGrid* from = nullptr,
                                                 const GridField* before = nullptr);

}  // namespace airlight::ray_marcher
