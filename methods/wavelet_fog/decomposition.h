// Mallat's decomposition of a map's coefficients: one level along u and v, then the same of the part that is coarse in
// both. Zero extension with index ranges that grow: nothing is cut off, so that reconstruction is exact to rounding.
// Giroud and Biri 2010, section 3.2.
#pragma once
#include "methods/wavelet_fog/filters.h"
#include "scene/media/spline_map.h"

namespace airlight::wavelet_fog {

// Coefficients of any sign, u fastest.
struct Coefficients {
  scene::IndexRange range;
  std::vector<double> values;
};

// Indices k that filters reach from a range, by c_i -> sum_i taps_{i-2k} c_i; and back, by a_k -> sum_k taps_{i-2k} a_k.
scene::IndexRange coarse_range(const scene::IndexRange&, const Taps& along_u, const Taps& along_v);
scene::IndexRange fine_range(const scene::IndexRange&, const Taps& along_both);
// The smallest range that contains both.
scene::IndexRange united(const scene::IndexRange&, const scene::IndexRange&);

// sum_i taps_{i-2k} c_i for every k that some c_i reaches, along u, then along v.
Coefficients filter_down(const Coefficients&, const Taps& along_u, const Taps& along_v);
// sum_k taps_{i-2k} a_k added to `fine`, along both.
void filter_up(const Coefficients& coarse, const Taps& along_u, const Taps& along_v, Coefficients& fine);

// One level: first letter along u, second along v; a is coarse (phi), d detail (psi). ad, da and dd are details 1 to 3 of Algorithm 1.
struct Bands {
  Coefficients aa, ad, da, dd;
};
Bands split(const Coefficients&, const Family&);
// The coefficients of that range again.
Coefficients join(const Bands&, const Family&, const scene::IndexRange&);

struct Decomposition {
  std::vector<Bands> levels;              // from the finest on; only the last keeps its aa
  std::vector<scene::IndexRange> ranges;  // of what each level was made from
};
// levels >= 1.
Decomposition decompose(Coefficients, const Family&, int levels);
Coefficients reconstruct(const Decomposition&, const Family&);

// The coarse coefficients of each level, from the map itself on: levels + 1 of them, by the filter `low`
// along both axes.
std::vector<Coefficients> approximations(const Coefficients&, const Taps& low, int levels);
// fine - P coarse, over every index that either reaches: what one level of wavelets adds, as splines of the finer level
// (the paper's deconstruction, section 4.3). Independent of the choice of q.
Coefficients difference(const Coefficients& fine, const Coefficients& coarse, int degree);
// The copy that can be rendered alone: negative values taken as 0, then one factor that restores the sum.
Coefficients clamped(Coefficients);

// floor(log2(max(width, height))): beyond it grids no longer shrink.
int most_levels(const scene::IndexRange&);

}  // namespace airlight::wavelet_fog
