// A map by its greatest wavelet coefficients: what the paper's "compresses well" is worth. Giroud and Biri 2010, sections 1 and 6.
#pragma once
#include <memory>

#include "methods/wavelet_fog/decomposition.h"
#include "methods/wavelet_fog/options.h"
#include "scene/scene.h"

namespace airlight::wavelet_fog {

// L2 norm over the plane of the function with these coefficients [cells].
double l2_norm(const Coefficients&, int degree);

struct Compressed {
  Coefficients map;  // reconstructed in the range of the original, negative values taken as 0
  long kept = 0;     // coefficients that are not 0
  double error = 0;  // L2, relative to the original's
};
// Keeps the share `keep` (0 to 1, rounded up) of as many coefficients as the map has: those of the greatest magnitude, times the L2 norm
// of their basis function. levels >= 1.
Compressed compress(const Coefficients&, const Family&, int levels, double keep);

struct CompressionReport {
  long kept;
  double error;
};
// The scene with every fogmap as `keep` and `degree` ask for; the same scene where they change nothing. `reports`, unless null, takes
// what became of each map that was compressed.
std::shared_ptr<const scene::Scene> with_maps_changed(std::shared_ptr<const scene::Scene>, const Options&,
                                                      std::vector<CompressionReport>* reports = nullptr);

}  // namespace airlight::wavelet_fog
