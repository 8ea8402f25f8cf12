#include "methods/compensated_ray_marching/smoke_volume.h"

#include <algorithm>
#include <cmath>

#include "scene/media/voxel.h"

namespace airlight::compensated_ray_marching {
namespace {

using Eigen::Vector3i;

constexpr double nothing_beyond_voxels = 6;  // widths: 2e-16 of the amplitude

// Calls of(voxel in the slice, value) for the voxels of slice k that a Gaussian reaches.
template <class Of>
void in_slice(const scene::VoxelGrid& grid, const scene::Gaussian& g, double cutoff, int k, const Of& of) {
  const Point3 center = world_to_sample(grid, g.center);
  const double width = g.width / grid.voxel_size, cut = std::min(cutoff, nothing_beyond_voxels), cut2 = cut * cut;
  const auto square = [&](int i, int axis) { return std::pow((i - center[axis]) / width, 2); };
  const auto first = [&](int axis) { return std::max(0, int(std::ceil(center[axis] - cut * width))); };
  const auto last = [&](int axis) {
    return std::min(grid.size[axis] - 1, int(std::floor(center[axis] + cut * width)));
  };
  const double dz = square(k, 2);
  if (!(dz <= cut2)) return;
  for (int j = first(1); j <= last(1); ++j)
    for (int i = first(0); i <= last(0); ++i)
      if (const double s = dz + square(j, 1) + square(i, 0); s <= cut2)
        of(i + std::size_t(grid.size[0]) * j, g.amplitude * std::exp(-s));
}

}  // namespace

SmokeVolume::SmokeVolume(const SmokeField& smoke, const scene::Execution& execution)
    : smoke_(smoke), densities_(std::size_t(smoke.voxels()->size.prod())) {
  const scene::VoxelGrid& grid = *smoke_.voxels();
  const std::size_t slice = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
  scene::parallel_for(grid.size[2], execution, [&](int k) {
    std::vector<double> sum(slice, smoke_.centres().constant);
    const auto add = [&](const std::vector<scene::Gaussian>& gaussians) {
      for (const scene::Gaussian& g : gaussians)
        in_slice(grid, g, smoke_.centres().cutoff, k, [&](std::size_t at, double value) { sum[at] += value; });
    };
    add(smoke_.centres().gaussians);
    add(smoke_.beyond());
    for (std::size_t at = 0; at < slice; ++at) {
      const Vector3i sample(int(at) % grid.size[0], int(at) / grid.size[0], k);
      const double rest = smoke_.residual() ? smoke_.residual()->at_sample(sample) : 0;
      densities_[std::size_t(k) * slice + at] =
          sum[at] < smoke_.least_density() ? 0 : float(std::max(0.0, sum[at] + rest));
    }
  });
}

SmokeVolume::Values SmokeVolume::values(const std::vector<Rgb>& towards, const scene::Execution& execution) const {
  const scene::VoxelGrid& grid = *smoke_.voxels();
  const std::vector<scene::Gaussian>& gaussians = smoke_.centres().gaussians;
  const std::size_t slice = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
  Values values(densities_.size());
  scene::parallel_for(grid.size[2], execution, [&](int k) {
    std::vector<double> weight(slice, 0.0);
    std::vector<Rgb> sum(slice, Rgb::Zero());
    for (std::size_t i = 0; i < gaussians.size(); ++i)
      in_slice(grid, gaussians[i], smoke_.centres().cutoff, k, [&](std::size_t at, double value) {
        weight[at] += value;
        sum[at] += value * towards[i];
      });
    for (std::size_t at = 0; at < slice; ++at) {
      const float density = densities_[std::size_t(k) * slice + at];
      Rgb source = Rgb::Zero();
      if (weight[at] >= smoke_.least_density()) source = density * (sum[at] / weight[at]).max(0);
      values[std::size_t(k) * slice + at] = {float(source[0]), float(source[1]), float(source[2]), density};
    }
  });
  return values;
}

SmokeVolume::Sample SmokeVolume::between(const Values& values, const Point3& x) const {
  const scene::VoxelGrid& grid = *smoke_.voxels();
  const Point3 sample = world_to_sample(grid, x);
  const double width = border_width(grid);
  for (int a = 0; a < 3; ++a)
    if (!(sample[a] >= -width && sample[a] <= grid.size[a] - 1 + width)) return {};
  const Vec3 low = sample.array().floor(), share = sample - low;
  const Vector3i first = low.cast<int>();
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  for (int c = 0; c < 8; ++c) {
    const Vector3i on(c & 1, c >> 1 & 1, c >> 2), there = first + on;
    const Vector3i within = there.cwiseMax(0).cwiseMin(grid.size - Vector3i::Ones());
    if (!grid.clamp_border && there != within) continue;
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= on[a] ? share[a] : 1 - share[a];
    const auto& v = values[std::size_t(within[0]) +
                           std::size_t(grid.size[0]) *
                               (std::size_t(within[1]) + std::size_t(grid.size[1]) * std::size_t(within[2]))];
    sum += weight * Eigen::Array4d(v[0], v[1], v[2], v[3]);
  }
  if (!(sum[3] > 0)) return {};
  return {sum[3], sum.head<3>() / sum[3]};
}

}  // namespace airlight::compensated_ray_marching
