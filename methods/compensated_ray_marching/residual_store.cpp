#include "methods/compensated_ray_marching/residual_store.h"

#include <cmath>

#include "scene/media/voxel.h"

namespace airlight::compensated_ray_marching {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// One sample more on every side, as far as a border is clamped at all; 0 beyond.
std::vector<std::int8_t> with_border(const scene::VoxelGrid& layout, const std::vector<std::int8_t>& levels) {
  const Vector3i size = layout.size, padded = size + Vector3i::Constant(2);
  std::vector<std::int8_t> all(std::size_t(padded.prod()), 0);
  for (int i = 0; i < padded.prod(); ++i) {
    const Vector3i there(i % padded[0] - 1, i / padded[0] % padded[1] - 1, i / padded[0] / padded[1] - 1);
    const Vector3i within = there.cwiseMax(0).cwiseMin(size - Vector3i::Ones());
    if (layout.clamp_border || there == within)
      all[std::size_t(i)] = levels[within[0] + std::size_t(size[0]) * (within[1] + size[1] * within[2])];
  }
  return all;
}

double level_between(const scene::PerfectHash& hash, const Vector3d& sample) {
  const Vector3d low = sample.array().floor(), f = sample - low;
  const Vector3i first = low.cast<int>();
  scene::Voxel v;
  for (int c = 0; c < 8; ++c) v.corner[c] = hash.value_by_domain(first + Vector3i(c & 1, c >> 1 & 1, c >> 2));
  return v.at(f[0], f[1], f[2]);
}

}  // namespace

StoredResidual::StoredResidual(const scene::Residual& residual, ResidualStore store)
    : layout_(residual.layout), step_(residual.step) {
  const std::vector<std::int8_t> levels = levels_of(residual.bricks);
  if (store == ResidualStore::bricks) {
    store_ = scene::apron_bricks_of(size(), with_border(layout_, levels));
  } else if (store == ResidualStore::hash) {
    store_ = scene::perfect_hash(size(), scene::hashed_voxels(size(), with_border(layout_, levels)));
  } else {
    scene::VoxelGrid grid = layout_;
    for (const std::int8_t level : levels) grid.values.push_back(float(step_ * level));
    store_ = std::move(grid);
  }
}

std::vector<std::int8_t> StoredResidual::levels() const {
  std::vector<std::int8_t> within;
  for (int z = 0; z < layout_.size[2]; ++z)
    for (int y = 0; y < layout_.size[1]; ++y)
      for (int x = 0; x < layout_.size[0]; ++x)
        within.push_back(std::int8_t(step_ > 0 ? std::lround(at_sample({x, y, z}) / step_) : 0));
  return with_border(layout_, within);
}

double StoredResidual::at(const Point3& x) const {
  if (const auto* grid = std::get_if<scene::VoxelGrid>(&store_)) return scene::density(*grid, x);
  const Point3 sample = world_to_sample(layout_, x);
  const double width = border_width(layout_);
  for (int a = 0; a < 3; ++a)
    if (!(sample[a] >= -width && sample[a] <= layout_.size[a] - 1 + width)) return 0;
  const Vector3d padded = sample + Vector3d::Ones();
  if (const scene::PerfectHash* h = hash()) return step_ * level_between(*h, padded);
  return step_ * scene::level_between(*bricks(), padded);
}

double StoredResidual::at_sample(const Vector3i& sample) const {
  if (const auto* grid = std::get_if<scene::VoxelGrid>(&store_)) return grid->at(sample[0], sample[1], sample[2]);
  const Vector3i padded = sample + Vector3i::Ones();
  if (const scene::PerfectHash* h = hash()) return step_ * h->value_by_domain(padded);
  return step_ * scene::level_between(*bricks(), padded.cast<double>());
}

const char* StoredResidual::name() const { return hash() ? "a hash" : bricks() ? "bricks" : "a grid"; }

}  // namespace airlight::compensated_ray_marching
