// A participating medium: a density field inside a region, with colour coefficients and a phase function.
//
//   extinction(x) = sigma_t * density(x) [1/m per channel],   scattering(x) = albedo * extinction(x)
//
// Several media at one point add. No emission. Index-matched, vacuum outside the regions.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/base/kinds.h"
#include "scene/media/gaussian_sum.h"
#include "scene/media/region.h"
#include "scene/phase.h"

namespace airlight::scene {

// Fields that a scene shares. Files that use the contents of a field include its header; most files that
// use a medium do not.
struct Fitted;
struct Fogmap;
class LegendreBox;
struct VoxelGrid;

struct Homogeneous {
  double density = 1;  // [-], >= 0
};

using GridPointer = std::shared_ptr<const VoxelGrid>;        // never null in a scene
using FogmapPointer = std::shared_ptr<const Fogmap>;         // never null in a scene
using LegendrePointer = std::shared_ptr<const LegendreBox>;  // never null in a scene
using FittedPointer = std::shared_ptr<const Fitted>;         // never null in a scene

// The closed set of density fields. Code that distinguishes them must name all of them (match), so that a new one does
// not compile where it is not handled. A renderer that does not support one refuses it by name (unknown_field).
using DensityField = std::variant<Homogeneous, GaussianSum, GridPointer, FogmapPointer, LegendrePointer, FittedPointer>;

double density(const DensityField&, const Point3& x);
Interval density_bounds(const DensityField&, const Box&);
double density_integral(const DensityField&, const Ray&, Interval t);
// The part of t outside which the field is zero or negligible, as `support` means it.
Interval extent(const DensityField&, const Ray&, Interval t);
// World box outside which the field is zero (or, for a field without a constant, negligible: below 1e-17 of its
// amplitude); infinite sides for an unbounded one.
Box support(const DensityField&);
// The density that it has everywhere, to which the rest adds [-]; and the world box of the rest, empty if there is none.
double constant_part(const DensityField&);
Box varied_support(const DensityField&);
// The density of a field that cannot vary [-]; nothing for the others.
std::optional<double> homogeneous_density(const DensityField&);
// Greatest density of any part of the field [-]. The sum can be greater where Gaussians overlap.
double greatest_density(const DensityField&);
std::string field_name(
    const DensityField&);  // "homogeneous", "gaussians", "grid", "fogmap", "legendre", "fitted", as in scene files
// [m] The smallest detail of samples that the field interpolates; infinity for a field without samples.
double detail(const DensityField&);
// Terms that are summed to evaluate the density at a point, without a constant.
double terms(const DensityField&);
// The field, displaced [m].
DensityField moved(const DensityField&, const Vec3& by);
// The voxels of a field whose density is trilinear between samples, a grid or fitted; null for the others.
const VoxelGrid* grid_of(const DensityField&);

struct Medium {
  std::string name;
  DensityField field = Homogeneous{};
  Region region = Unbounded{};
  Rgb sigma_t = Rgb::Ones();  // [1/m] per unit density, >= 0
  Rgb albedo = Rgb::Ones();   // in [0, 1]
  PhaseFunction phase = Isotropic{};
};

// Is there any extinction at all: a sigma_t above 0, and a density.
bool extinguishes(const Medium&);

// "medium 'smoke'", or "medium 0" without a name: begins a refusal.
std::string label(const std::vector<Medium>&, std::size_t i);
// Why a renderer that knows no other fields than these cannot render that medium; empty if it can.
template <class... Known>
std::string unknown_field(const std::vector<Medium>& media, std::size_t i) {
  const std::string other = unknown_kind<Known...>(media[i].field, field_name);
  return other.empty() ? "" : label(media, i) + " is " + other;
}

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
