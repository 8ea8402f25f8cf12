// Variant S-K, not in the paper: the ray is cut into K slices; the optical depth is exact at their edges, and inside a
// slice the airlight is integrated in closed form with the depth, and 1/distance^2 in the angle, taken as linear. The
// error falls as K^-2 for any number of Gaussians and any optical depth; extrapolated from K/2 and K slices, which
// share their edges and so all depths, as K^-4.
#pragma once
#include <vector>

#include "methods/fogshop/homogeneous_airlight.h"
#include "scene/math/types.h"

namespace airlight::fogshop {

// Every other edge of an even number of slices, with the padding that add_slices wants: what is left is the same
// placement with half the slices.
void every_other(const std::vector<double>& all, int slices, std::vector<double>& half);

// Adds, per channel, the airlight of the slices from one light of 1 W/sr and albedo 1. view_depth and light_depth are
// the depths [-], hue 1, from the camera and from the light to the edges, the medium's constant included; all three
// arrays hold slices + 1 values and room for 8 more. source_radius softens 1/d^2 [m]. What the slices scatter is what
// they extinguish, or, if `scattering` is not null, the differences of its array for each channel (as long as the
// others).
void add_slices(const double* t, const double* view_depth, const double* light_depth, const double* const* scattering,
                int slices, const LightFromRay&, double source_radius, const Rgb& hue, bool coloured, Rgb& airlight);

}  // namespace airlight::fogshop
