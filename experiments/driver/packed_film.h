// A reference film made small enough to be committed: one layer, and what its errors and intervals need.
//
// A film without noise keeps the layer exactly. For a noisy film the metrics need the sixteen batches (batches.h),
// whose last digits are noise. A batch is stored as a whole number k of steps: base + (k + 1/2 - u) step. The step of a
// value is the largest power of two that is not above the scatter of its batches. The number u in (0, 1) is random, but
// depends on pixel and batch alone, so that reading finds it again (subtractive dither). The rounding error is then
// uniform over one step and independent of the batch and of the other batches. Its effect is that of a few samples
// less: it adds 2.1 to 8.3 % to the variance (4.5 % on average) and no bias. The stored batches show it, so intervals,
// noise floors and tests of equality include it.
//
// Values whose batches are all equal are kept exactly, with their standard error (an upper end, batches.h).
#pragma once
#include <string>

#include "scene/film/film.h"

namespace airlight::experiments {

// Writes the packed film. Metadata is kept; "kept" says in a sentence what the file holds. Throws Error if the layer is
// missing, not finite, or noisy without batches.
void write_packed(const std::string& path, const scene::Film&, const std::string& layer);

// The film again: the layer, and where it is noisy its batches and its standard error, from the batches. Throws Error as
// read_exr, and if the file is no packed film.
scene::Film read_packed(const std::string& path);

}  // namespace airlight::experiments
