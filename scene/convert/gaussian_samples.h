// A sum of Gaussians at the sample points of a grid.
#pragma once
#include <vector>

#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {

// The sum, with its constant, at the samples of `layout` (whose values are not looked at), x fastest: those of `density` to single
// precision, the cutoff's jump included, except that it is not clamped at 0. Beyond 8.9 widths (1e-35) a Gaussian counts as 0. The grid
// may be turned and moved. threads: 0 is all; the same bits for any number. Cost: about 0.3 ns per sample of a Gaussian's ball.
std::vector<float> gaussian_samples(const GaussianSum&, const VoxelGrid& layout, int threads = 0);

}  // namespace airlight::scene
