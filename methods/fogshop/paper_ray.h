// The Gaussian terms of the paper's airlight along one ray, on vectors: Zhou et al. 2007, Eqs. 9 to 13.
#pragma once
#include "methods/fogshop/kernels.h"

namespace airlight::fogshop {

// Contribution of one light per Gaussian, equal for all rays of a view.
struct PaperLight {
  Point3 position;
  double softness = 0;  // r_s^2 [m^2]
  double g = 0;         // of the phase function
  // E_i = T_i(s,b_i) + T_i(v,b_i) - T(s,b_i) - T(v,b_i): the exponent of f^1 with the compensation of f^0; by place in
  // the whole arrays [-], for an extinction ratio of 1, the constant term of the medium included.
  std::vector<double> exponent;
};

// Adds, per channel, sum over the crossed Gaussians of f^0 f^1 T_i(v,p) for an intensity of 1 W/sr. `gaussians` are
// those that were crossed; `exponent` is by their `index`. Three channels if `coloured`, else the first only. Where the
// Gaussians have colours, each term is scaled by its Gaussian's. T_i(v,p) is Crossings::whole, T_i(v,b_i^r) to_nearest.
void add_gaussian_terms(const GaussianArrays& gaussians, const Crossings&, const Line& view, const PaperLight&, Erf,
                        const Rgb& extinction_ratio, bool coloured, Rgb& airlight);

}  // namespace airlight::fogshop
