// Section 5.3 of Zhou et al. 2007: airlight and optical depth of every pixel.
#pragma once
#include <vector>

#include "methods/fogshop/ray_airlight.h"

namespace airlight::fogshop {

struct AirlightImage {
  std::vector<Rgb> airlight;  // L_a [W/m^2/sr], row 0 at the top
  std::vector<double> depth;  // T(v, p) [-], hue 1
  double evaluations = 0;     // of the error function
  double crossed = 0;         // pairs of pixel and Gaussian
  double candidates = 0;      // the same for the lists of the tiles
};

// `distance` is d_vp of every pixel [m], infinite where nothing is hit. Tiles of 8 x 8 pixels first list the Gaussians
// that any of their rays may meet: those whose sphere touches the tile's cone.
AirlightImage airlight_pass(const Model&, const ViewModel&, const scene::View&, const std::vector<double>& distance,
                            const scene::Execution&);

}  // namespace airlight::fogshop
