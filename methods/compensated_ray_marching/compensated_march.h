// The march along a view ray, written out as in the text: density from Gaussians and residual, source radiance interpolated from the
// Gaussians' centres and multiplied by that density. Zhou et al. 2008, Eq. 14 to 16, sections 5.5 and 5.6. This is the form to read and to
// check against; pictures march in picture.cpp (PreparedPicture::pixel).
#pragma once
#include <memory>
#include <vector>

#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::compensated_ray_marching {

// The smoke that is marched through.
struct MarchedSmoke {
  scene::GaussianSum gaussians;
  std::vector<std::vector<Rgb>> source;              // at each centre, order^2 coefficients of propagation directions
  std::shared_ptr<const scene::VoxelGrid> residual;  // of either sign, trilinear; null: none
  Rgb extinction;                                    // sigma_t [1/m]
};

// Factor on a slice's source. printed: its depth across (section 5.5, before Eq. 16); paper: its depth
// along the ray, which is the depth across over the cosine (section 5.6); exact: 1 - exp(-depth), since
// the slice absorbs its own light, too.
enum class SliceWeight { printed, paper, exact };
// For a slice's depth along the ray; cosine: of the angle between the ray and the axis across the slices.
Rgb seen(const Rgb& depth, double cosine, SliceWeight);

struct Slices {
  Vec3 axis;         // unit, across the slices
  double thickness;  // [m]
  int count;         // from the ray's origin on
};

struct Marched {
  Rgb radiance = Rgb::Zero();  // without what is behind
  Rgb transmittance = Rgb::Ones();
};

// Density max(0, D~ + R), and 0 where D~ is below 1e-10, which only places beyond all Gaussians are; source radiance towards the viewer, at
// least 0: the mean of the centres' weighted with the Gaussians.
class CompensatedMarch {
 public:
  // Throws Error where sources and Gaussians differ in number.
  explicit CompensatedMarch(MarchedSmoke);
  // One sample in the middle of each slice.
  Marched slices(const Ray&, const Slices&, SliceWeight) const;

 private:
  struct Sample {
    double density;
    Rgb source;
  };
  Sample at(const Point3&, const std::vector<Rgb>& towards_viewer) const;
  std::vector<Rgb> sources_towards(const Vec3& viewer) const;

  MarchedSmoke smoke_;
};

}  // namespace airlight::compensated_ray_marching
