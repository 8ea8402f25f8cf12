// Eq. 26 of Zhou et al. 2007 for the Gaussians of a fog, on vectors.
#pragma once
#include "methods/fogshop/gaussian_arrays.h"

namespace airlight::fogshop {

// Mean optical depth of all Gaussians over all directions from the point [-], at extinction ratio 1: the sum of c / a average_depth
// (surface_psf.h), by DawsonFit. All are summed: the mean falls as 1/distance^2 only.
double average_depth_of(const GaussianArrays&, const Point3&);
// Sum over the Gaussians in [begin, end). Arrays extend by GaussianArrays::padding beyond `end`, or end
// at a multiple of it from `begin`.
double average_depth_of(const GaussianArrays&, int begin, int end, const Point3&);

}  // namespace airlight::fogshop
