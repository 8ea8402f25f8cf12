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
  // The Gaussians that rays are marched through. Null if there are none, if a region cuts them off, or
  // if voxels replace them.
  const scene::GaussianSum* gaussians() const { return gaussians_; }
  // Gaussians at whose centres the light is computed: amplitude above 0, centre within the region
  // (variant `paper` only).
  const scene::GaussianSum& centres() const { return centres_; }
  // Gaussians centred outside the region, which add to the density within it (variant `paper` through voxels only).
  const std::vector<scene::Gaussian>& beyond() const { return beyond_; }
  // The voxels of fitted smoke (variant `paper` only); null for other smoke.
  const scene::VoxelGrid* voxels() const { return voxels_; }
  // Least density of the Gaussians with a source: 1e-10 of the greatest amplitude, and no less than the
  // smallest normal float.
  double least_density() const { return least_density_; }
  bool with_residual() const { return residual_.has_value(); }
  // The residual that is added to the Gaussians (variant `paper` only); null if none is added.
  const StoredResidual* residual() const { return residual_ ? &*residual_ : nullptr; }

  // The part of a ray that is in the smoke.
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
