// The medium of a scene as it is marched through.
#pragma once
#include <optional>

#include "methods/compensated_ray_marching/gaussian_row.h"
#include "methods/compensated_ray_marching/options.h"

namespace airlight::compensated_ray_marching {

// variant = grid marches through the medium itself; so does paper through a sum of Gaussians. Through fitted smoke paper marches from voxel
// to voxel (smoke_volume.h): what Gaussians and residual have together is known there, and nothing is known beyond. Without `residual`
// fitted smoke is what its Gaussians alone have at the voxels, for both variants. A region cuts off all of them.
class SmokeField {
 public:
  // Takes a medium of which `unsupported` names nothing, and copies it where its residual is left out.
  SmokeField(const scene::Medium&, const Options&);

  const scene::Medium& medium() const { return own_ ? *own_ : *given_; }
  // That rays are marched through; null where there are none, a region cuts them off, or voxels stand for them.
  const scene::GaussianSum* gaussians() const { return gaussians_; }
  // Of paper: the Gaussians at whose centres light is found, those of an amplitude within the region.
  const scene::GaussianSum& centres() const { return centres_; }
  // Of paper through voxels: Gaussians with their centres beyond the region, which add to the density within it.
  const std::vector<scene::Gaussian>& beyond() const { return beyond_; }
  // Of paper, the voxels of fitted smoke; null: it is none.
  const scene::VoxelGrid* voxels() const { return voxels_; }
  // Of the Gaussians, where they have a source: 1e-10 of the greatest amplitude, no less than a float holds with all its digits.
  double least_density() const { return least_density_; }
  bool with_residual() const { return residual_.has_value(); }
  // Of paper, where it is added to the Gaussians; null: it is not.
  const StoredResidual* residual() const { return residual_ ? &*residual_ : nullptr; }

  // Where it is along a ray.
  Interval extent(const Ray&, Interval) const;
  // From the Gaussians' density, where they are marched through (row), or from the field itself.
  double density(const Point3&, double of_gaussians) const;

 private:
  void find_centres(const scene::GaussianSum&);

  const scene::Medium* given_;
  std::optional<scene::Medium> own_;
  const scene::GaussianSum* gaussians_ = nullptr;
  const scene::VoxelGrid* voxels_ = nullptr;
  scene::GaussianSum centres_;
  std::vector<scene::Gaussian> beyond_;
  double least_density_ = 0;
  std::optional<StoredResidual> residual_;
};

}  // namespace airlight::compensated_ray_marching
