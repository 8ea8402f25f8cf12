// Airlight of a point light in a homogeneous medium: the homogeneous term of Zhou et al. 2007 (Eqs. 14 to 17), after
// Sun et al. 2005. beta is extinction = scattering [1/m], the phase function is isotropic.
#pragma once

namespace airlight::fogshop {

// F(u, v) = integral over x in [0, v] of exp(-u tan x) dx, for u >= 0, 0 <= v <= pi/2. Relative error 1e-13.
double F(double u, double v);

// A point light seen from a ray: the ray passes it at distance h >= 0 [m], at the ray parameter `along` [m] (negative
// if it lies behind the origin).
struct LightFromRay {
  double along;
  double h;
};

// Radiance over ray parameters [0, d_vp] for an intensity of 1 W/sr; d_vp may be infinite. Closed form in scaled
// exponential integrals, Gauss-Legendre where that form would cancel; relative error 1e-12. Infinite if the segment
// passes through the light.
double homogeneous_airlight(const LightFromRay&, double d_vp, double beta);

// L_a^h(gamma, d_sv, d_vp, beta): the same airlight in the paper's variables. gamma is the angle between the ray and
// the direction to the light [rad, 0 to pi], d_sv the light's distance [m]. (The paper's "cos gamma = r . r_sv" has the
// wrong sign under its own definition of r_ab.)
double homogeneous_airlight(double gamma, double d_sv, double d_vp, double beta);

// Airlight with 1/d^2 replaced by 1/(d^2 + radius^2); the lengths in the exponent are not changed. radius >= 0 [m].
double softened_homogeneous_airlight(const LightFromRay&, double d_vp, double beta, double radius);

}  // namespace airlight::fogshop
