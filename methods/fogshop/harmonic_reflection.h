// Incident radiance in spherical harmonics, reflected by a surface: Zhou et al. 2007, section 4.3, Eq. 20 without
// visibility.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::fogshop {

// Integral over the hemisphere of brdf * cosine * incident radiance [W/m^2/sr], per channel. `incident` holds order^2
// coefficients [W/m^2/sr] of directions towards the light (scene/math/spherical_harmonics.h), order at most 12; the
// result is linear in them. Vectors are unit; 0 if the view is below the surface. Lambert in closed form; the lobe of
// Phong by 384 directions around its axis, which are as many for every exponent.
Rgb reflect_harmonics(const scene::Material&, const Vec3& normal, const Vec3& to_view,
                      const std::vector<Rgb>& incident);

}  // namespace airlight::fogshop
