// A participating medium: a density field inside a region, with colour coefficients and a phase function.
//
//   extinction(x) = sigma_t * density(x) [1/m per channel],   scattering(x) = albedo * extinction(x)
//
// Several media at one point add. No emission. Index-matched, vacuum outside the regions.
#pragma once
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "scene/media/gaussian_sum.h"
#include "scene/media/region.h"
#include "scene/media/voxel_grid.h"
#include "scene/phase.h"

namespace airlight::scene {

struct Homogeneous {
  double density = 1;  // [-], >= 0
};

// The closed set of density fields. The fogmap (Giroud and Biri 2010) and the Legendre box (Gupta and Narasimhan 2007)
// join here: a field answers density, density_bounds, density_integral, support.
using DensityField = std::variant<Homogeneous, GaussianSum, std::shared_ptr<const VoxelGrid>>;

double density(const DensityField&, const Point3& x);
Interval density_bounds(const DensityField&, const Box&);
double density_integral(const DensityField&, const Ray&, Interval t);
// The part of t outside which the field is zero or negligible, as `support` means it.
Interval extent(const DensityField&, const Ray&, Interval t);
// World box outside which the field is zero (or, for a field without a constant, negligible: below 1e-17 of its
// amplitude); infinite sides for an unbounded one.
Box support(const DensityField&);
std::string field_name(const DensityField&);  // "homogeneous", "gaussians", "grid"

struct Medium {
  std::string name;
  DensityField field = Homogeneous{};
  Region region = Unbounded{};
  Rgb sigma_t = Rgb::Ones();  // [1/m] per unit density, >= 0
  Rgb albedo = Rgb::Ones();   // in [0, 1]
  PhaseFunction phase = Isotropic{};
};

// Density at x, 0 outside the region [-]; times sigma_t it is the extinction.
double density(const Medium&, const Point3& x);

// Rigorous bounds over a box, region included [-].
Interval density_bounds(const Medium&, const Box&);

// Integral of the density along the ray, region included [m]; noise-free, t1 may be infinite (the answer then too, if
// the medium is unbounded). Times sigma_t it is the optical depth.
double density_integral(const Medium&, const Ray&, Interval t);

// Where the ray meets the medium's region and the support of its field; empty if nowhere. For a Gaussian field without
// a constant this is where it is not negligible.
Interval extent(const Medium&, const Ray&, Interval t);

// Smallest box around the medium.
Box bounding_box(const Medium&);

// Over all media: extinction [1/m] at x, optical depth [-] and transmittance [-] along the ray, per channel.
Rgb extinction(const std::vector<Medium>&, const Point3& x);
Rgb optical_depth(const std::vector<Medium>&, const Ray&, Interval t);
Rgb transmittance(const std::vector<Medium>&, const Ray&, Interval t);

}  // namespace airlight::scene
