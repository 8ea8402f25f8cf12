// Reflection of light that is known by its spherical harmonics: Zhou et al. 2007, Eq. 20 and section 4.3.
//
// Real harmonics in world axes as in scene/math/spherical_harmonics.h, order^2 coefficients, order 1 to 12 (the paper
// uses 4 to 6). Throws Error for a number of coefficients that is none of these.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"
#include "scene/math/types.h"

namespace airlight::fogshop {

// B_pv: coefficients of brdf(in, to_view) max(0, normal . in) as a function of `in`. `normal` is on the viewer's side;
// zero if to_view is below the horizon. Lambert in closed form; others by quadrature over the hemisphere, 512 directions
// and for Phong exponents above 50 in proportion to the exponent.
std::vector<Rgb> reflectance_harmonics(const scene::Material&, const Vec3& normal, const Vec3& to_view, int order);

// Radiance towards the viewer [W/m^2/sr]: the inner product of `reflectance` (B_pv, or its product with a visibility,
// TripleProduct) and `incident` radiance. Not clamped: cut-off harmonics may swing below 0.
Rgb reflect_harmonics(const std::vector<Rgb>& reflectance, const std::vector<Rgb>& incident);
// Reflected radiance for incident light of 1 with these zonal bands around `to_light`: Eq. 25.
Rgb reflect_zonal(const std::vector<Rgb>& reflectance, const std::vector<double>& bands, const Vec3& to_light);

// A function that is circularly symmetric about z, given by its coefficients of m = 0, turned to another axis: Eq. 23.
std::vector<double> turned_zonal(const std::vector<double>& bands, const Vec3& axis);

// Coefficients of max(0, cos theta) about z, by band: 2 pi integral over x in [0, 1] of x Y_l0(x).
std::vector<double> clamped_cosine(int order);

}  // namespace airlight::fogshop
