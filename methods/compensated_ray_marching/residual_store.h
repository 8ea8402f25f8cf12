// The residual of fitted smoke after subtracting its Gaussians, for lookups between samples while rays are marched:
// Zhou et al. 2008, sections 5.2 and 5.6.
#pragma once
#include <variant>

#include "scene/convert/perfect_hash.h"
#include "scene/convert/residual.h"

namespace airlight::compensated_ray_marching {

// grid: all samples, decoded once, a float each; on a device 8 bits. bricks: in 8 bits, those that hold something, with an apron. hash: in
// 8 bits, a perfect hash with domain bits, as published; eight look-ups between samples. automatic: grid on a processor, bricks on a device.
enum class ResidualStore { automatic, grid, bricks, hash };

// Residual of either sign, trilinear between samples. It is 0 beyond the border; within half a voxel of the border it
// is clamped if the grid's values are. All stores give equal values; a grid rounds them to floats.
class StoredResidual {
 public:
  StoredResidual(const scene::Residual&, ResidualStore);

  double at(const Point3&) const;                  // density
  double at_sample(const Eigen::Vector3i&) const;  // the residual density at a sample of the layout
  // Density of a level, and where the samples lie: without values. Levels of bricks and hash have one sample more on every side: size().
  double step() const { return step_; }
  const scene::VoxelGrid& layout() const { return layout_; }
  Eigen::Vector3i size() const { return layout_.size + Eigen::Vector3i::Constant(2); }
  // Levels of all samples with this border, x fastest.
  std::vector<std::int8_t> levels() const;
  // Null: it is stored in another way.
  const scene::ApronBricks* bricks() const { return std::get_if<scene::ApronBricks>(&store_); }
  const scene::PerfectHash* hash() const { return std::get_if<scene::PerfectHash>(&store_); }
  const char* name() const;  // "a grid", ...

 private:
  scene::VoxelGrid layout_;
  double step_;
  std::variant<scene::VoxelGrid, scene::ApronBricks, scene::PerfectHash> store_;
};

}  // namespace airlight::compensated_ray_marching
