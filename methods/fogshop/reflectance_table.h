// A reflectance times cosine in spherical harmonics for every view direction: B_pv of Zhou et al. 2007, section 4.3,
// as a table over the angle between normal and viewer.
//
// For an isotropic material the harmonics about the normal, with the viewer in the half-plane of x > 0, y = 0, depend
// on that angle alone. The light of a point source is zonal about the direction to it, so that nothing is rotated: the
// inner product is taken in the surface's frame.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"
#include "scene/math/types.h"

namespace airlight::fogshop {

class ReflectanceTable {
 public:
  // `order` bands, 1 to 12; throws Error. Entries at the polar angles of a tabulated material, between which it is
  // linear as this is; 193 for others, which leaves 1e-3 of a coefficient in the highest band.
  ReflectanceTable(const scene::Material&, int order);

  // Integral of brdf * cosine * (the zonal function with these `bands`, as many as the order, around `to_light`) over
  // the hemisphere.
  Rgb reflect(const Vec3& normal, const Vec3& to_view, const Vec3& to_light, const std::vector<double>& bands) const;

  // Coefficients in the surface's frame for a viewer at theta_out [rad].
  std::vector<Rgb> harmonics(double theta_out) const;

 private:
  int order_, entries_;
  std::vector<Rgb> values_;  // order^2 for every entry
};

}  // namespace airlight::fogshop
