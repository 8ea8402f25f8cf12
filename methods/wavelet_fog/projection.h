// The orthogonal projection of splines onto those with cells twice as large: what any coarse approximation is measured
// against. Its filters never end; here the finite system is solved.
#pragma once
#include "methods/wavelet_fog/decomposition.h"

namespace airlight::wavelet_fog {

// Along u, of every row: onto the coarse splines whose support meets that of the fine ones. degree: 0 to 3.
Coefficients orthogonal_projection(const Coefficients&, int degree);

}  // namespace airlight::wavelet_fog
