// The medium of a scene as it is marched through.
#pragma once
#include <optional>

#include "methods/compensated_ray_marching/gaussian_row.h"
#include "methods/compensated_ray_marching/options.h"

namespace airlight::compensated_ray_marching {

// variant = grid marches through the medium itself; paper through Gaussians, with what they leave of fitted smoke (trilinear, of either
// sign) where `residual` asks for it and they leave anything, and without density where the Gaussians have less than least_density().
class SmokeField {
 public:
  // Of a medium that reasons_against has nothing against. The medium is copied where its residual is left out, and of paper, which has an
  // equation for every Gaussian, where some have no amplitude: they are left out.
  SmokeField(const scene::Medium&, const Options&);

  const scene::Medium& medium() const { return own_ ? *own_ : *given_; }
  // The Gaussians; null where there are none, or a region cuts them off.
  const scene::GaussianSum* gaussians() const { return gaussians_; }
  // Of the Gaussians, where they have a source: 1e-10 of the greatest amplitude, no less than a float holds with all its digits.
  double least_density() const { return least_density_; }
  bool with_residual() const { return residual_.has_value(); }
  // Of fitted smoke, where it is added to the Gaussians; null: it is not.
  const StoredResidual* residual() const { return residual_ ? &*residual_ : nullptr; }

  // Where it is along a ray.
  Interval extent(const Ray&, Interval) const;
  // From the Gaussians' density, where they are marched through (row), or from the field itself.
  double density(const Point3&, double of_gaussians) const;

 private:
  const scene::Medium* given_;
  std::optional<scene::Medium> own_;
  const scene::GaussianSum* gaussians_ = nullptr;
  double least_density_ = 0;
  std::optional<StoredResidual> residual_;
};

}  // namespace airlight::compensated_ray_marching
