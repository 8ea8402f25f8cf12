// A reflectance times cosine in spherical harmonics for every view direction: B_pv of Zhou et al. 2007, section 4.3,
// as a table over the angle between normal and viewer.
//
// For an isotropic material the harmonics about the normal, with the viewer in the half-plane of x > 0, y = 0, depend
// on that angle alone; from there they are turned into the world's axes.
#pragma once
#include <optional>
#include <vector>

#include "scene/math/types.h"
#include "scene/scene.h"

namespace airlight::fogshop {

class ReflectanceTable {
 public:
  // `order` bands, 1 to 12; throws Error. Entries at the polar angles of a tabulated material, between which it is
  // linear as this is; 193 for others, which leaves 1e-3 of a coefficient in the highest band.
  ReflectanceTable(const scene::Material&, int order);

  // Coefficients in the surface's frame for a viewer at theta_out [rad].
  std::vector<Rgb> harmonics(double theta_out) const;
  // In the world's axes; zero for a viewer below the horizon.
  std::vector<Rgb> turned(const Vec3& normal, const Vec3& to_view) const;

  int entries() const { return entries_; }                    // even over theta_out in [0, pi/2], both ends included
  const std::vector<Rgb>& values() const { return values_; }  // order^2 for every entry

 private:
  int order_, entries_;
  std::vector<Rgb> values_;
};

// B_pv of all surfaces: Lambert in closed form, others by their tables.
class SurfaceReflectances {
 public:
  SurfaceReflectances(const std::vector<scene::Surface>&, int order);

  // order^2 coefficients in the world's axes, `normal` on the viewer's side.
  std::vector<Rgb> operator()(const scene::Scene&, int surface, const Vec3& normal, const Vec3& to_view) const;

  int order() const { return order_; }
  const std::vector<std::optional<ReflectanceTable>>& tables() const { return tables_; }  // by surface; none: Lambert

 private:
  int order_;
  std::vector<std::optional<ReflectanceTable>> tables_;
};

}  // namespace airlight::fogshop
