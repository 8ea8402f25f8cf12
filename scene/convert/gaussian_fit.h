// A voxel grid as a sum of Gaussians, cut at three widths: least squares over all voxels by centres, widths and amplitudes. Zhou et al.
// 2008, section 5.1.
//
// One frame (fit_gaussians), or the next of a sequence (next_fit), which begins with the Gaussians of the frame before and keeps who is
// who: a Gaussian's id is the same in every frame it is in, so that others may interpolate between frames.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "scene/base/settings.h"
#include "scene/convert/fit_objective.h"
#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {

inline constexpr double fit_cutoff = 3;           // [widths]
inline constexpr int most_fit_gaussians = 65536;  // a fit's memory is about 8 KB each
// [voxels]: below it samples no longer say what a Gaussian is. Added up they are at most 5 % off its integral at this width, 60 % at 0.5,
// four times too much at 0.35: 1 + 6 exp(-(pi width)^2) + ... of the lattice's Fourier series.
inline constexpr double least_fit_width = 0.7;

// gauss_newton: closed-form normal matrix, ours; lbfgs: Ceres' line search (fit_lbfgs.h), there to be compared with.
enum class FitMethod { gauss_newton, lbfgs };
const Choices<FitMethod>& fit_methods();
FitMethod fit_method_from(const std::string& name);  // throws Error

// Where the least significant Gaussians are sent between rounds: nowhere; where density is missing most; there and to random filled
// voxels by turns, as Zhou et al. 2008, section 5.1, have it.
enum class Teleport { none, greatest, alternating };
const Choices<Teleport>& teleports();

struct FitOptions {
  int gaussians = 1000;  // 1 to most_fit_gaussians; fewer where fewer voxels are filled
  // Unit of lengths [m]. 0: cube root of the volume of the grid's box, with voxels counted as cubes for
  // any side lengths.
  double unit = 0;
  // In units; the lower one at least so many voxels, the upper at least twice the lower.
  Interval widths = {0.015, 0.09};
  double least_voxels = least_fit_width;
  Interval amplitudes = {0.01, 1};  // over the greatest density
  FitMethod method = FitMethod::gauss_newton;
  // Rounds of `iterations`, each followed by teleportation, until one lowers the objective by less than `tolerance` of it.
  int rounds = 12, iterations = 5;
  double tolerance = 2e-3;
  // Rounds and tolerance for later frames, which start close to their solution.
  int later_rounds = 6;
  double later_tolerance = 1e-2;
  Teleport teleport = Teleport::greatest;
  bool polish = true;  // amplitudes alone at the end, by bounded linear least squares
  // A sequence: how many of the least significant go; and, where the squared ratio is above `allowed` times that of the first frame, how
  // many come where density is missing; with `resent`, others are teleported there too, as new ones with new ids. The publication's
  // sequences teleport none, and follow slow smoke.
  int deleted = 3, inserted = 8;
  double allowed = 1.1;
  bool resent = true;
  int threads = 0;                   // 0: all; the same bits for any number
  std::function<void()> check = {};  // called now and then; may throw to stop
};

struct GaussianFit {
  GaussianSum sum;       // world; empty for an empty grid
  std::vector<int> ids;  // of each Gaussian, >= 0
  FitErrors errors;
  double first_ratio = 0;  // squared ratio of the sequence's first frame that was not empty; 0 before it
  int next_id = 0;         // that a Gaussian still to come would get
  std::size_t evaluations = 0;
  int iterations = 0, teleported = 0, deleted = 0, inserted = 0;
  bool warm = false;
  double seconds = 0;  // wall clock
};

// Throws Error for options out of range.
void check_fit_options(const FitOptions&);

// Throws Error where a density is not finite or negative (with its index), for options out of range.
GaussianFit fit_gaussians(const VoxelGrid&, const FitOptions&);

// The frame after `previous`, the fit of the last frame that was not empty (without one of those: its own result for an empty frame): a
// frame after it that is empty has no Gaussians, and what follows goes on from `previous` again.
GaussianFit next_fit(const VoxelGrid&, const GaussianFit& previous, const FitOptions&);

// Length of the unit [m] by default.
double fit_unit(const VoxelGrid&);

// `id,center_x,center_y,center_z,width,amplitude`, a row each, every number to its last bit: a [[medium]] of type "gaussians" reads it
// (with cutoff = 3). Atomic. Throws Error.
void write_gaussians_csv(const std::string& path, const GaussianFit&);

}  // namespace airlight::scene
