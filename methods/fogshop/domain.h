// Where the approximations hold, scene by scene: what lies clearly outside is refused, what may be off is said with the
// picture.
//
// Eqs. 10 to 13 (variant `paper`) take the light and its way at one point of the ray, the projection of the Gaussian's
// centre. For a Gaussian of width w whose point is d from the light that leaves out
//   1.5 (w/d)^2 of the inverse square: w^2/4 f''/f of f = 1/(t^2 + h^2), at most 6/d^2 * w^2/4;
//   y^2/6 of the attenuation: y/sinh(y) for an optical depth of y, lit from the viewer's side.
// Each is a quarter at `least_widths` and `deepest`. A light in a Gaussian wider than its distance from the camera is
// nearer to every ray than the Gaussian is wide, so that no pixel is right: its light grows like w, its true light does
// not (0.5 too much at once the distance, 13 times too much at 19, linearly on; a closed form in a test).
// Eq. 28 lights all of a ray of depth T by T e^-T; seen from outside, a cloud differs by up to T/2 of that.
#pragma once
#include "methods/fogshop/model.h"

namespace airlight::fogshop {

constexpr double least_widths = 2.45, deepest = 1.2, deepest_sky = 0.5;

// Why the scene lies clearly outside what the variant can do; empty if it does not. Source: above.
std::string objection_to_domain(const scene::Scene&, const Fog&, const Options&);

// Warning, in one line, about parts of pictures that may be wrong by more than a quarter; empty if there are none.
std::string doubt_of(const scene::Scene&, const Fog&, const Options&);

}  // namespace airlight::fogshop
