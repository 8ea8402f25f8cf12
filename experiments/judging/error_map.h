// Where two pictures differ, in false colours.
#pragma once
#include <string>

#include "scene/film/film.h"

namespace airlight::experiments {

// The layer `mean` of the result shows |luminance of the difference| over the reference's mean luminance: 0 is dark violet, `top` and more
// yellow (viridis), so that an 8-bit picture of it has these colours. A pixel of the map shows the mean error of `shrink` x `shrink` pixels.
// Throws Error where the films' sizes differ, a layer is missing or `shrink` does not divide the film's size.
scene::Film error_map(const scene::Film& image, const scene::Film& reference, const std::string& layer, double top,
                      int shrink = 1);

}  // namespace airlight::experiments
