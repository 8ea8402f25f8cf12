// A lat-long map on spherical harmonics. About the map's pole the sums separate: Fourier sums of each row, then sums over the rows.
#pragma once
#include <vector>

#include "scene/light/environment.h"

namespace airlight::scene {

// A pair (l, m), 0 <= m <= l < order, stands at l (l + 1) / 2 + m.
inline int pair_count(int order) { return order * (order + 1) / 2; }

// Contribution of a row's Fourier sum of frequency m, over its texels at azimuths 2 pi (i + 1/2) / width, to the
// coefficients of a pair: by pair, then by row. Rows are linear in the angle from centre to centre and constant in the
// caps; columns are linear, too.
std::vector<double> row_weights(int order, int width, int height);

// The projected map about its own pole, from three sums with the cosine and three with the sine for each pair.
EnvironmentLight about_pole(int order, const std::vector<double>& sums);

// A map's projection on harmonics about the map's own pole; relative error below 1e-12.
EnvironmentLight map_about_pole(const EnvironmentMap&, int order);

}  // namespace airlight::scene
