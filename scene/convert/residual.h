// Difference between a voxel grid and a sum of Gaussians, R = D - D~ at the samples, in 8 bits a sample.
// Zhou et al. 2008, section 5.2: level = round(R / step), |level| <= 127, small levels dropped.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/convert/residual_bricks.h"
#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {

struct QuantisationOptions {
  int threshold = 0;  // levels of this size or less become 0; 0 to 126
  // Density of one level [-], > 0; what passes 127 of them is cut off. By default the largest |R| is 127 levels.
  std::optional<double> step;
  // Used by residual_of(): samples without density get none, for any threshold, because levels are rounded down there.
  // Without it, Gaussians leave up to half a level, or the threshold, in empty space.
  bool keep_empty = false;
};

// Samples as levels, x fastest, as those of a VoxelGrid.
struct ResidualLevels {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  double step = 0;                  // [-]; 0 where there is nothing to quantise
  std::vector<std::int8_t> values;  // -127 to 127
};

// Throws Error for options out of range, a number of values that is not that of the size, or one that is not finite (with its index).
ResidualLevels quantised(const Eigen::Vector3i& size, const std::vector<double>& residual, const QuantisationOptions&);

// The residual of one frame with all that it takes to get the frame back.
struct Residual {
  VoxelGrid layout;           // of the grid that it was made from, without values
  double cutoff = infinity;   // of the Gaussians it belongs to [widths]
  std::string gaussians_key;  // and their content: another sum cannot be taken for it
  int threshold = 0;
  double step = 0;        // [-] a level
  ResidualBricks bricks;  // 8^3
};

// 32 hex digits for the Gaussians in their order and the constant; the cutoff is left out, Residual has it.
std::string content_of(const GaussianSum&);

// The residual of a grid against Gaussians. Throws Error as quantised().
Residual residual_of(const VoxelGrid&, const GaussianSum&, const QuantisationOptions&);

// The grid that Gaussians and levels stand for: max(0, D~ + step level) at the samples of `layout`. Levels may be absent (size 0): the
// Gaussians alone. A D~ below the least normal float is 0.
VoxelGrid decoded(const VoxelGrid& layout, const GaussianSum&, const ResidualLevels&);
// Whether the residual was made against these Gaussians, cut off where they are.
bool belongs_to(const Residual&, const GaussianSum&);
// Throws Error where it was not.
VoxelGrid decoded(const GaussianSum&, const Residual&);

}  // namespace airlight::scene
