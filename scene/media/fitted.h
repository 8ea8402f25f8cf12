// A voxel grid as a sum of Gaussians and what that leaves, the residual: Zhou et al. 2008, section 3.3. Its density is that of the grid
// that both stand for; Gaussians and residual stay at hand for renderers that work with them.
#pragma once
#include <memory>

#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {

struct Residual;

struct Fitted {
  GaussianSum gaussians;
  std::shared_ptr<const Residual> residual;  // null: the Gaussians alone
  VoxelGrid grid;                            // max(0, Gaussians + residual) at the samples, trilinear between them
};

}  // namespace airlight::scene
