// Eq. 26 of Zhou et al. 2007 for the Gaussians of a fog, on vectors.
#pragma once
#include "methods/fogshop/gaussian_arrays.h"

namespace airlight::fogshop {

// Mean optical depth of all Gaussians over all directions from the point [-], hue 1: the sum of c / a average_depth
// (surface_psf.h), from a table, to 1e-8 of itself or better. All are summed: the mean falls as 1/distance^2 only.
double average_depth_of(const GaussianArrays&, const Point3&);

}  // namespace airlight::fogshop
