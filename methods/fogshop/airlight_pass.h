// Section 5.3 of Zhou et al. 2007: airlight and optical depth of every pixel.
#pragma once
#include <vector>

#include "methods/fogshop/ray_airlight.h"

namespace airlight::fogshop {

struct AirlightImage {
  std::vector<Rgb> airlight;  // L_a [W/m^2/sr], row 0 at the top
  std::vector<double> depth;  // T(v, p) [-], at extinction ratio 1
  double evaluations = 0;     // of the error function
  double crossed = 0;         // pairs of pixel and Gaussian
  double candidates = 0;      // pairs of pixel and Gaussian in the lists of the tiles
};

// `distance` is d_vp of every pixel [m], infinite where nothing is hit. Tiles of 8 x 8 pixels first list the Gaussians
// that any of their rays may meet: those whose sphere touches the tile's cone. With a `step` above 1 there is one ray
// through the middle of each block of step x step pixels, and one distance and result for each (low_resolution.h).
AirlightImage airlight_pass(const Model&, const ViewModel&, const scene::View&, const std::vector<double>& distance,
                            const scene::Execution&, int step = 1);

// Computes the pixels of `image` whose `only` is not 0 and leaves the others alone; adds to its counters. Tiles without
// any cost nothing.
void airlight_again(const Model&, const ViewModel&, const scene::View&, const std::vector<double>& distance,
                    const std::vector<unsigned char>& only, const scene::Execution&, AirlightImage& image);

}  // namespace airlight::fogshop
