// A ray through the wavelets themselves: approximation and three kinds of details a level, as Algorithm 1 reads them before
// deconstruction. Giroud and Biri 2010, eq. 10 and 11 with phi-psi for the psi-psi that is printed twice; Table 3, "before".
#pragma once
#include "methods/wavelet_fog/decomposition.h"
#include "methods/wavelet_fog/levels.h"

namespace airlight::wavelet_fog {

// Integral over t of the details of one level times the height's factor [unit of t]: exact to rounding where that is made of straight
// lines. `fine` is any map over the cells that the details lie on (level l: 2^l of the finest a side). A cell of level l + 1 counts as a
// visit and reads 2 (n+1) w + w^2 coefficients, w the cells that a wavelet is wide.
double integral_of_bands(const scene::SplineMap& fine, const Bands&, const Family&, int level,
                         const scene::HeightProfile&, const scene::MapLine&, Interval t, Visits&);

// As summed_depth, by wavelets. The levels have details.
double banded_depth(const Levels&, const Decomposition&, const Family&, const scene::HeightProfile&,
                    const scene::MapLine&, Interval inside, double length, double mu, Visits&);

}  // namespace airlight::wavelet_fog
