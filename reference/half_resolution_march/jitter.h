// Offsets of the steps of a marched pixel, ordered or as noise: neighbours together sample what one alone would miss.
#pragma once
#include "reference/half_resolution_march/options.h"

namespace airlight::half_resolution_march {

// The ordered matrix of Bayer 1973, 8 x 8, repeated: every number of [0, 64) once.
int bayer(int x, int y);

// In (0, 1): what share of a step lies before its sample, for a pixel of the marched film and a frame >= 0. `noise` is
// interleaved gradient noise (Jimenez 2014): any 3 x 3 pixels have nearly equally spaced offsets, and it needs no file. A frame adds
// the golden ratio, modulo 1: the offsets of a pixel spread evenly for any number of frames.
double step_offset(Jitter, int x, int y, int frame);

}  // namespace airlight::half_resolution_march
